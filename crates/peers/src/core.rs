//! Keeping to one core.

#[cfg(target_os = "linux")]
use rustix::thread::{CpuSet, Pid, sched_setaffinity};

/// Keeps all threads that there are, and whatever they start, on the core that this thread is on,
/// from now on.
///
/// Libraries that build with several threads leave some behind that wait for more to do, busily: on
/// a core that shares its units with this one they would slow down all that is timed here. Does
/// nothing where the system cannot.
#[cfg(target_os = "linux")]
pub fn keep_to_one_core() {
    let mut one = CpuSet::new();
    one.set(rustix::thread::sched_getcpu());
    // Threads that end meanwhile, or are not ours to move, stay as they are.
    let threads = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    for thread in threads {
        let number = thread.file_name().to_str().and_then(|name| name.parse().ok());
        if let Some(thread) = number.and_then(Pid::from_raw) {
            let _ = sched_setaffinity(Some(thread), &one);
        }
    }
}

/// Does nothing: this system has no way that is known here.
#[cfg(not(target_os = "linux"))]
pub fn keep_to_one_core() {}
