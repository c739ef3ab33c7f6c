//! Which thread looks after which sources.
//!
//! What a thread has written it finds again in its own cache, and what another has written it must fetch
//! from there: so the same thread looks after the same sources in every step, as long as it is free. Two that
//! write to one line of cache take it from each other all the time: what each writes into is aligned to
//! lines of its own (pairs of them, which come together), or in some runs a third of the gain is lost.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// So often a thread looks whether the others are done before it falls asleep: some tenths of a millisecond.
const A_WHILE: usize = 10_000;

/// In place of a thread.
const NOBODY: usize = usize::MAX;

/// Which thread had each share last.
#[derive(Debug, Default)]
pub(super) struct Shares {
    owners: Vec<AtomicUsize>,
}

impl Shares {
    /// Makes so many shares.
    pub(super) fn share_out(&mut self, shares: usize) {
        self.owners.resize_with(shares, || AtomicUsize::new(NOBODY));
    }

    /// Does each piece of work, one to a share, on the thread that had the share last, if that is free.
    pub(super) fn each<T: Send>(&self, pieces: &mut [T], work: impl Fn(&mut T) + Sync) {
        let count = pieces.len();
        let desk = Mutex::new(pieces.iter_mut().zip(&self.owners).collect::<Vec<_>>());
        let done = AtomicUsize::new(0);
        let next = |me: usize| {
            let mut waiting = desk.lock().ok()?;
            let had_by =
                |who| waiting.iter().position(|(_, owner)| owner.load(Ordering::Relaxed) == who);
            let place = had_by(me).or_else(|| had_by(NOBODY)).unwrap_or(0);
            (!waiting.is_empty()).then(|| waiting.swap_remove(place))
        };
        let work_off = || {
            let me = rayon::current_thread_index().unwrap_or(NOBODY);
            while let Some((piece, owner)) = next(me) {
                owner.store(me, Ordering::Relaxed);
                work(piece);
                done.fetch_add(1, Ordering::Release);
            }
        };
        rayon::in_place_scope(|scope| {
            for _ in 1..count {
                scope.spawn(|_| work_off());
            }
            work_off();
            // The others are about to be done: to fall asleep and be woken would take longer.
            for _ in 0..A_WHILE {
                if done.load(Ordering::Acquire) == count {
                    break;
                }
                std::hint::spin_loop();
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_piece_of_work_is_done_once() {
        for threads in 1..4 {
            let pool =
                rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            let mut shares = Shares::default();
            shares.share_out(3);
            let mut pieces = [0; 3];
            for _ in 0..100 {
                pool.install(|| shares.each(&mut pieces, |piece| *piece += 1));
            }
            assert_eq!(pieces, [100; 3]);
        }
    }
}
