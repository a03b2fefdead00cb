//! What a run took: `--stats`.

use std::path::Path;
use std::time::Instant;

use nestray::core::simd::Level;
use nestray::render::ray_counts::RayCounts;
use nestray::scene::scene::Scene;
use serde_json::{Map, Value, json};

use crate::errors::Failure;
use crate::output;

/// Times by stage, and whatever else is worth keeping.
#[derive(Debug)]
pub(crate) struct Stats {
    begun: Instant,
    stages: Vec<(&'static str, f64)>,
    facts: Map<String, Value>,
}

impl Stats {
    pub(crate) fn new() -> Self {
        Self { begun: Instant::now(), stages: Vec::new(), facts: Map::new() }
    }

    /// Does something and adds its time to a stage.
    pub(crate) fn stage<T>(&mut self, name: &'static str, work: impl FnOnce() -> T) -> T {
        let begun = Instant::now();
        let result = work();
        let seconds = begun.elapsed().as_secs_f64();
        match self.stages.iter_mut().find(|stage| stage.0 == name) {
            Some(stage) => stage.1 += seconds,
            None => self.stages.push((name, seconds)),
        }
        result
    }

    /// Seconds of a stage so far.
    pub(crate) fn seconds(&self, name: &str) -> f64 {
        self.stages.iter().find(|stage| stage.0 == name).map_or(0.0, |stage| stage.1)
    }

    /// Keeps a fact.
    pub(crate) fn set(&mut self, name: &str, value: impl Into<Value>) {
        self.facts.insert(name.into(), value.into());
    }

    /// Keeps what a scene is made of.
    pub(crate) fn set_scene(&mut self, scene: &Scene) {
        let stored: u64 = scene.geometries.iter().map(|g| u64::from(g.primitives())).sum();
        self.set(
            "scene",
            json!({ "geometries": scene.geometries.len(), "groups": scene.groups.len(),
                "primitives_stored": stored, "primitives": scene.primitives(),
                "lights": scene.lights.len() }),
        );
    }

    /// Keeps how many rays there were, and how fast they were.
    pub(crate) fn set_rays(&mut self, rays: &RayCounts) {
        let each = rays.each().into_iter().map(|(kind, count)| {
            (kind.to_owned(), json!({ "cast": count.cast, "hit": count.hit }))
        });
        let seconds = self.seconds("render");
        self.set("rays", Value::Object(each.collect()));
        self.set("rays_per_second", rays.total().cast as f64 / seconds.max(1e-9));
    }

    /// As JSON.
    pub(crate) fn to_json(&self) -> Value {
        let stages: Map<String, Value> =
            self.stages.iter().map(|&(name, seconds)| (name.to_owned(), seconds.into())).collect();
        let mut all = json!({
            "nestray": env!("CARGO_PKG_VERSION"),
            "vector_level": level(),
            "seconds": self.begun.elapsed().as_secs_f64(),
            "stages": stages,
            "peak_memory_bytes": peak_memory(),
        });
        if let Some(object) = all.as_object_mut() {
            object.extend(self.facts.clone());
        }
        all
    }

    /// Writes it, if asked to.
    pub(crate) fn write(&self, path: Option<&Path>) -> Result<(), Failure> {
        let Some(path) = path else { return Ok(()) };
        output::write(path, format!("{:#}\n", self.to_json()).as_bytes())
    }
}

/// The vector instructions in use.
pub(crate) fn level() -> String {
    let name = format!("{:?}", Level::best());
    name.split('(').next().unwrap_or_default().to_lowercase()
}

/// What the system calls the processor, or at least its kind.
pub(crate) fn processor() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = info.lines().find(|line| line.starts_with("model name"));
    let name = line.and_then(|line| line.split(':').nth(1)).unwrap_or(std::env::consts::ARCH);
    name.trim().to_owned()
}

/// Most memory in use at any time, if the system says so.
pub(crate) fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}
