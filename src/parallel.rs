//! Threads that stay awake for work handed out in small pieces.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::Yield;

/// More threads find nothing to do in one leaf.
const MOST: usize = 4;

/// Among how many threads the work of one leaf is shared out.
#[must_use]
pub fn hands() -> usize {
    rayon::current_num_threads().min(MOST)
}

/// Runs `work` while the other threads of the current rayon pool look for pieces of it without falling
/// asleep.
///
/// Growing one leaf hands out pieces of some tens of microseconds, several in every step: less than a thread
/// takes to wake. Costs the time of up to three threads for as long as the work takes, so it is for one leaf
/// at a time and pays where growth of closed venation takes most of it (0.67 of the time on two threads at a
/// million sources); leaves of a batch are pieces large enough. Results do not depend on it.
pub fn awake<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    /// Lets the threads go, also when the work panics.
    struct Done<'a>(&'a AtomicBool);
    impl Drop for Done<'_> {
        fn drop(&mut self) {
            self.0.store(true, Ordering::Release);
        }
    }
    let is_done = AtomicBool::new(false);
    rayon::scope(|scope| {
        let done = Done(&is_done);
        for _ in 1..hands() {
            scope.spawn(|_| {
                while !is_done.load(Ordering::Acquire) {
                    if rayon::yield_now() != Some(Yield::Executed) {
                        // On a busy machine someone else has use for the time.
                        std::thread::yield_now();
                    }
                }
            });
        }
        let result = work();
        drop(done);
        result
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gives_the_result_of_work_that_shares_itself_out() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("a pool");
        let sum = |n: u64| pool.install(|| awake(|| rayon::join(|| n, || n + 1)));
        for n in 0..100 {
            assert_eq!(sum(n), (n, n + 1));
        }
        assert_eq!(awake(|| 7), 7);
    }

    #[test]
    fn lets_the_threads_go_when_the_work_panics() {
        let caught = std::panic::catch_unwind(|| awake(|| panic!("as a test")));
        assert!(caught.is_err());
    }
}
