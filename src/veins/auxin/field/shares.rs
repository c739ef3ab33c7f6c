//! Which thread looks after which columns of cells.
//!
//! What a thread has written it finds again in its own cache, and what another has written it must fetch
//! from there: so the same thread looks after the same columns in every step, as long as the work is
//! shared out evenly enough.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A share may have so many times the work of an even one before the columns are shared out anew.
const UNEVEN: f64 = 1.3;

/// So often a thread looks whether the others are done before it falls asleep: some tenths of a millisecond.
const A_WHILE: usize = 10_000;

/// In place of a thread.
const NOBODY: usize = usize::MAX;

/// Columns by thread.
#[derive(Debug, Default)]
pub(super) struct Shares {
    /// Where each share but the first begins.
    cuts: Vec<usize>,
    /// Which thread had each share last.
    owners: Vec<AtomicUsize>,
}

impl Shares {
    /// Shares out columns anew, which have come to mean other places.
    pub(super) fn forget(&mut self) {
        self.cuts.clear();
    }

    /// Where each share but the first begins.
    pub(super) fn cuts(&self) -> &[usize] {
        &self.cuts
    }

    /// Shares the columns out to so many threads, where there is work in some columns, unless they are
    /// and each has about as much work.
    pub(super) fn share_out(&mut self, threads: usize, work: impl Iterator<Item = usize>) {
        let mut columns: Vec<usize> = work.collect();
        let most = UNEVEN * columns.len() as f64 / threads as f64;
        if self.cuts.len() + 1 == threads {
            let mut shares = vec![0_usize; threads];
            for column in &columns {
                shares[self.cuts.partition_point(|cut| cut <= column)] += 1;
            }
            if shares.iter().all(|&share| share as f64 <= most) {
                return;
            }
        }
        let count = columns.len();
        let cut = |i: usize| *columns.select_nth_unstable(i * count / threads).1;
        self.cuts = (1..threads).map(cut).collect();
        self.owners.resize_with(threads, || AtomicUsize::new(NOBODY));
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
    fn columns_are_shared_out_anew_only_where_one_has_too_much() {
        let mut shares = Shares::default();
        shares.share_out(2, 0..10);
        assert_eq!(shares.cuts(), [5]);
        shares.share_out(2, 1..11);
        assert_eq!(shares.cuts(), [5], "four and six are even enough");
        shares.share_out(2, 4..14);
        assert_eq!(shares.cuts(), [9]);
        shares.share_out(3, 0..9);
        assert_eq!(shares.cuts(), [3, 6]);
    }

    #[test]
    fn each_piece_of_work_is_done_once() {
        for threads in 1..4 {
            let pool =
                rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            let mut shares = Shares::default();
            shares.share_out(3, 0..9);
            let mut pieces = [0; 3];
            for _ in 0..100 {
                pool.install(|| shares.each(&mut pieces, |piece| *piece += 1));
            }
            assert_eq!(pieces, [100; 3]);
        }
    }
}
