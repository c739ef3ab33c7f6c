//! The sources in reach of a node.

/// Those of one band of cells.
#[derive(Debug, Clone, Default)]
#[repr(align(128))]
pub(in super::super) struct Acting {
    /// Ascending.
    ids: Vec<u32>,
    /// Those that came into reach since they were last merged with these.
    arrived: Vec<u32>,
}

impl Acting {
    pub(super) fn arrive(&mut self, id: u32) {
        self.arrived.push(id);
    }

    /// The list of those that came, for whoever finds out on the way that sources come, and back.
    pub(super) fn lend(&mut self, arrived: &mut Vec<u32>) {
        std::mem::swap(&mut self.arrived, arrived);
    }

    pub(in super::super) fn len(&self) -> usize {
        self.ids.len() + self.arrived.len()
    }

    pub(in super::super) fn iter(&self) -> impl Iterator<Item = u32> + '_ {
        self.ids.iter().chain(&self.arrived).copied()
    }

    /// Those that came last, all of them of this id or a later one.
    pub(super) fn arrived_since(&self, first: u32) -> impl Iterator<Item = u32> + '_ {
        self.arrived.iter().rev().copied().take_while(move |&id| id >= first)
    }

    /// Asks each in the order of their ids whether it stays.
    pub(in super::super) fn retain(&mut self, mut stays: impl FnMut(u32) -> bool) {
        self.arrived.sort_unstable();
        merge(&mut self.ids, &self.arrived);
        self.arrived.clear();
        self.ids.retain(|&id| stays(id));
    }
}

/// Merges an ascending list into another, from the back and in place.
fn merge(into: &mut Vec<u32>, other: &[u32]) {
    let (mut a, mut b) = (into.len(), other.len());
    into.resize(a + b, 0);
    for at in (0..a + b).rev() {
        if b == 0 {
            break;
        }
        if a > 0 && into[a - 1] > other[b - 1] {
            a -= 1;
            into[at] = into[a];
        } else {
            b -= 1;
            into[at] = other[b];
        }
    }
}
