//! Work shared out among threads: lists filled piece by piece, threads that stay awake for small pieces,
//! and memory that all of them ask for.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::Yield;
use rayon::prelude::*;

/// More threads find nothing to do in one leaf.
const MOST: usize = 4;

/// Among how many threads the work of one leaf is shared out.
#[must_use]
pub(crate) fn hands() -> usize {
    rayon::current_num_threads().min(MOST)
}

/// Fewer elements are written sooner than handed out.
const WORTH_SHARING: usize = 1 << 16;

/// So many elements, all of them `value`.
///
/// The system hands out memory page by page where it is first written to, which takes longer than the
/// writing: of much memory every thread asks for a part.
#[must_use]
pub(crate) fn filled<T: Copy + Send + Sync>(len: usize, value: T) -> Vec<T> {
    if len < WORTH_SHARING || hands() == 1 {
        return vec![value; len];
    }
    rayon::iter::repeat_n(value, len).collect()
}

/// Makes room in a list for `more` elements. On several threads half of it is asked for here and now, as
/// [`filled`] does it, and not by the one thread that fills the list later; `value` stands for any.
pub(crate) fn make_room<T: Copy + Send + Sync>(list: &mut Vec<T>, more: usize, value: T) {
    list.reserve(more);
    if more >= WORTH_SHARING && hands() > 1 {
        let len = list.len();
        list.par_extend(rayon::iter::repeat_n(value, more / 2));
        list.truncate(len);
    }
}

/// Fills a list on all threads, in pieces of `len` (the last may be shorter): `fill` gets the number of a
/// piece and the piece.
///
/// By reference, so that handing out is built once for a kind of element and not for every caller: of a
/// closure that rayon splits a compiler makes two dozen functions.
pub(crate) fn for_each_piece<T: Send>(
    list: &mut [T],
    len: usize,
    fill: &(dyn Fn(usize, &mut [T]) + Sync),
) {
    list.par_chunks_mut(len.max(1)).enumerate().for_each(|(i, piece)| fill(i, piece));
}

/// Runs `work` while the other threads of the current rayon pool look for pieces of it without falling
/// asleep.
///
/// Growing one leaf hands out pieces of some tens of microseconds, several in every step: less than a thread
/// takes to wake. Costs the time of up to three threads for as long as the work takes, so it is for one leaf
/// at a time and pays where growth of closed venation takes most of it (0.65 of the time on two threads at a
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
    fn every_piece_of_a_list_is_filled_once() {
        let mut list = vec![0; 23];
        for_each_piece(&mut list, 5, &|i, piece| {
            let len = piece.len();
            piece.iter_mut().for_each(|value| *value += 100 * i + len);
        });
        let expected: Vec<usize> =
            (0..23).map(|k| 100 * (k / 5) + if k < 20 { 5 } else { 3 }).collect();
        assert_eq!(list, expected);
        for_each_piece(&mut [0_u8; 0], 0, &|_, _| panic!("there is none"));
    }

    #[test]
    fn room_is_made_behind_what_is_there() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("a pool");
        for len in [10, WORTH_SHARING + 1] {
            let mut list = pool.install(|| filled(len, 7_u8));
            assert_eq!(list, vec![7; len]);
            pool.install(|| make_room(&mut list, 2 * WORTH_SHARING, 0));
            assert_eq!(list, vec![7; len]);
            assert!(list.capacity() >= len + 2 * WORTH_SHARING);
        }
    }

    #[test]
    fn lets_the_threads_go_when_the_work_panics() {
        let caught = std::panic::catch_unwind(|| awake(|| panic!("as a test")));
        assert!(caught.is_err());
    }
}
