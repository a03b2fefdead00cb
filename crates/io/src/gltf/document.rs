//! The parts of a glTF document that are used, as they stand in its JSON.

use std::collections::BTreeMap;

use serde::Deserialize;

/// Declares structs whose fields may all be missing, named as JSON likes it.
macro_rules! parts {
    ($($name:ident { $($(#[$attribute:meta])* $field:ident: $kind:ty,)* })+) => {
        $(#[derive(Debug, Default, Deserialize)]
        #[serde(rename_all = "camelCase", default)]
        pub(super) struct $name { $($(#[$attribute])* pub(super) $field: $kind,)* })+
    };
}

parts! {
    Document {
        asset: Asset, extensions_used: Vec<String>, extensions_required: Vec<String>,
        scene: Option<usize>, scenes: Vec<Roots>, nodes: Vec<Node>, meshes: Vec<Mesh>,
        accessors: Vec<Accessor>, buffer_views: Vec<View>, buffers: Vec<Buffer>,
        materials: Vec<Material>, textures: Vec<Texture>, images: Vec<Image>,
        samplers: Vec<Sampler>, skins: Vec<Skin>, animations: Vec<Animation>,
        cameras: Vec<Camera>, extensions: DocumentExtensions,
    }
    DocumentExtensions {
        #[serde(rename = "KHR_lights_punctual")]
        lights: Lights,
    }
    Asset { version: Option<String>, min_version: Option<String>, }
    Roots { nodes: Vec<usize>, }
    Node {
        name: String, children: Vec<usize>, mesh: Option<usize>, skin: Option<usize>,
        camera: Option<usize>, matrix: Option<[f32; 16]>, translation: Option<[f32; 3]>,
        rotation: Option<[f32; 4]>, scale: Option<[f32; 3]>, weights: Vec<f32>,
        extensions: NodeExtensions,
    }
    NodeExtensions {
        #[serde(rename = "KHR_lights_punctual")]
        light: Option<LightOf>,
        #[serde(rename = "EXT_mesh_gpu_instancing")]
        instancing: Option<Instancing>,
    }
    LightOf { light: usize, }
    Instancing { attributes: BTreeMap<String, usize>, }
    Mesh { name: String, primitives: Vec<Primitive>, weights: Vec<f32>, }
    Primitive {
        attributes: BTreeMap<String, usize>, indices: Option<usize>, material: Option<usize>,
        mode: Option<u32>, targets: Vec<BTreeMap<String, usize>>, extensions: PrimitiveExtensions,
    }
    PrimitiveExtensions {
        #[serde(rename = "KHR_draco_mesh_compression")]
        draco: Option<serde::de::IgnoredAny>,
    }
    Accessor {
        buffer_view: Option<usize>, byte_offset: usize, component_type: u32, normalized: bool,
        count: usize, #[serde(rename = "type")] shape: String, sparse: Option<Sparse>,
    }
    Sparse { count: usize, indices: SparseIndices, values: SparseValues, }
    SparseIndices { buffer_view: usize, byte_offset: usize, component_type: u32, }
    SparseValues { buffer_view: usize, byte_offset: usize, }
    View {
        buffer: usize, byte_offset: usize, byte_length: usize, byte_stride: Option<usize>,
        extensions: ViewExtensions,
    }
    ViewExtensions {
        #[serde(rename = "EXT_meshopt_compression")]
        meshopt: Option<serde::de::IgnoredAny>,
        #[serde(rename = "KHR_meshopt_compression")]
        khr_meshopt: Option<serde::de::IgnoredAny>,
    }
    Buffer { uri: Option<String>, }
    Image { uri: Option<String>, buffer_view: Option<usize>, name: String, }
    Sampler { mag_filter: Option<u32>, wrap_s: Option<u32>, wrap_t: Option<u32>, }
    Texture { name: String, sampler: Option<usize>, source: Option<usize>, }
    Material {
        name: String, pbr_metallic_roughness: Metallic, normal_texture: Option<TextureOf>,
        emissive_texture: Option<TextureOf>, emissive_factor: Option<[f32; 3]>,
        alpha_mode: Option<String>, alpha_cutoff: Option<f32>, extensions: MaterialExtensions,
    }
    Metallic {
        base_color_factor: Option<[f32; 4]>, base_color_texture: Option<TextureOf>,
        metallic_factor: Option<f32>, roughness_factor: Option<f32>,
        metallic_roughness_texture: Option<TextureOf>,
    }
    MaterialExtensions {
        #[serde(rename = "KHR_materials_unlit")]
        unlit: Option<serde::de::IgnoredAny>,
        #[serde(rename = "KHR_materials_emissive_strength")]
        emissive: EmissiveStrength,
        #[serde(rename = "KHR_materials_transmission")]
        transmission: Transmission,
        #[serde(rename = "KHR_materials_ior")]
        ior: Ior,
        #[serde(rename = "KHR_materials_pbrSpecularGlossiness")]
        gloss: Option<Gloss>,
    }
    EmissiveStrength { emissive_strength: Option<f32>, }
    Transmission { transmission_factor: f32, transmission_texture: Option<TextureOf>, }
    Ior { ior: Option<f32>, }
    Gloss {
        diffuse_factor: Option<[f32; 4]>, diffuse_texture: Option<TextureOf>,
        glossiness_factor: Option<f32>,
    }
    TextureOf {
        index: usize, tex_coord: usize, scale: Option<f32>, extensions: TextureExtensions,
    }
    TextureExtensions {
        #[serde(rename = "KHR_texture_transform")]
        transform: Option<TextureTransform>,
    }
    TextureTransform {
        offset: Option<[f32; 2]>, rotation: f32, scale: Option<[f32; 2]>,
        tex_coord: Option<usize>,
    }
    Skin { name: String, inverse_bind_matrices: Option<usize>, joints: Vec<usize>, }
    Animation { name: String, channels: Vec<Channel>, samplers: Vec<AnimationSampler>, }
    Channel { sampler: usize, target: Target, }
    Target { node: Option<usize>, path: String, }
    AnimationSampler { input: usize, output: usize, interpolation: Option<String>, }
    Camera { name: String, perspective: Option<Perspective>, orthographic: Option<Orthographic>, }
    Perspective { yfov: f32, }
    Orthographic { ymag: f32, }
    Lights { lights: Vec<Light>, }
    Light {
        name: String, #[serde(rename = "type")] kind: String, color: Option<[f32; 3]>,
        intensity: Option<f32>, spot: Spot,
    }
    Spot { inner_cone_angle: Option<f32>, outer_cone_angle: Option<f32>, }
}

/// Extensions that are read, or that change nothing one can see here.
pub(super) const KNOWN_EXTENSIONS: &[&str] = &[
    "EXT_mesh_gpu_instancing",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_xmp",
    "KHR_xmp_json_ld",
];
