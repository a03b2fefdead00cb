// tinybvh behind the C interface of nestray-peers: names, types and meaning are those in
// `src/plugin/kernel.rs`. `cargo xtask peers` compiles it against tinybvh's one header.

#define NO_THREADED_BUILDS
#define TINYBVH_IMPLEMENTATION
#include "tiny_bvh.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace {

struct RayRecord {
    float origin[3], t_min, dir[3], t_max;
};

struct HitRecord {
    float t, u, v;
    uint32_t primitive;
};

struct Scene {
    bool best;
    std::vector<tinybvh::bvhvec4> corners;
    tinybvh::BVH8_CPU tree;
};

// Directions keep their length, so that distances count in it.
tinybvh::Ray ray_of(const RayRecord& record) {
    tinybvh::Ray ray;
    ray.O = tinybvh::bvhvec3(record.origin[0], record.origin[1], record.origin[2]);
    ray.D = tinybvh::bvhvec3(record.dir[0], record.dir[1], record.dir[2]);
    ray.rD = tinybvh::tinybvh_rcp(ray.D);
    ray.hit.t = record.t_max < BVH_FAR ? record.t_max : BVH_FAR;
    return ray;
}

} // namespace

extern "C" {

uint32_t nestray_peer_count() { return 2; }

const char* nestray_peer_name(uint32_t which) {
    return which == 0 ? "tinybvh BVH8_CPU" : "tinybvh BVH8_CPU HQ";
}

#define TEXT_OF(x) #x
#define TEXT(x) TEXT_OF(x)

const char* nestray_peer_version(uint32_t) {
    return TEXT(TINY_BVH_VERSION_MAJOR) "." TEXT(TINY_BVH_VERSION_MINOR) "." TEXT(TINY_BVH_VERSION_SUB);
}

Scene* nestray_peer_new(uint32_t which, const float (*positions)[3], size_t, const uint32_t (*faces)[3],
                        size_t face_count) {
    Scene* scene = new Scene{which == 1, {}, {}};
    scene->corners.reserve(3 * face_count);
    for (size_t face = 0; face < face_count; face++)
        for (uint32_t corner : faces[face]) {
            const float* at = positions[corner];
            scene->corners.push_back(tinybvh::bvhvec4(at[0], at[1], at[2], 0));
        }
    return scene;
}

void nestray_peer_build(Scene* scene) {
    uint32_t count = uint32_t(scene->corners.size() / 3);
    if (scene->best)
        scene->tree.BuildHQ(scene->corners.data(), count);
    else
        scene->tree.Build(scene->corners.data(), count);
}

uint64_t nestray_peer_bytes(const Scene* scene) { return uint64_t(scene->tree.usedBlocks) * 64; }

void nestray_peer_closest(const Scene* scene, const RayRecord* rays, HitRecord* hits, size_t count) {
    for (size_t i = 0; i < count; i++) {
        tinybvh::Ray ray = ray_of(rays[i]);
        float before = ray.hit.t;
        scene->tree.Intersect(ray);
        if (ray.hit.t < before)
            hits[i] = {ray.hit.t, ray.hit.u, ray.hit.v, ray.hit.prim};
        else
            hits[i] = {std::numeric_limits<float>::infinity(), 0, 0, UINT32_MAX};
    }
}

void nestray_peer_any(const Scene* scene, const RayRecord* rays, bool* blocked, size_t count) {
    for (size_t i = 0; i < count; i++) blocked[i] = scene->tree.IsOccluded(ray_of(rays[i]));
}

void nestray_peer_free(Scene* scene) { delete scene; }

}
