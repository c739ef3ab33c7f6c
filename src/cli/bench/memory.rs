//! How much memory a run takes.

/// Memory of this process that is in use now, in bytes; `None` where the system does not say.
pub(super) fn now() -> Option<u64> {
    status("VmRSS:")
}

/// The most that was in use since [`forget_peak`], in bytes.
pub(super) fn peak() -> Option<u64> {
    status("VmHWM:")
}

/// Starts to look for the peak anew. Where the system refuses, peaks of earlier runs count on.
pub(super) fn forget_peak() {
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// A line of Linux's account of this process, which is in kB.
fn status(name: &str) -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find(|line| line.starts_with(name))?;
    let kilobytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(target_os = "linux")]
    fn the_peak_sees_what_is_gone() {
        const SIZE: usize = 64 << 20;
        let before = now().expect("Linux says");
        drop(std::hint::black_box(vec![1u8; SIZE]));
        assert!(peak().expect("Linux says") >= before + SIZE as u64 / 2);
    }
}
