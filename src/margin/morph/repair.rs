//! Outlines on the way that cross themselves, made simple.

use super::super::Outline;
use crate::geometry::polygon;

/// The outline without its loops: where it crosses itself, the stretch between is left away, unless base
/// or apex lies on it. `None` when one does.
pub(super) fn without_loops(mut outline: Outline) -> Option<Outline> {
    loop {
        let crossings = polygon::crossings(&outline.points);
        let free = |&(i, j): &(usize, usize)| j < outline.apex || i >= outline.apex;
        let Some(&(first, _)) = crossings.first() else { return Some(outline) };
        // Of the crossings of an edge the farthest: its loop holds those of the others.
        let mut same = crossings.iter().filter(|(i, _)| *i == first);
        let &(i, j) = same.rfind(|pair| free(pair))?;
        let n = outline.points.len();
        let [a, b] = [i, i + 1].map(|k| outline.points[k]);
        let [c, d] = [j, (j + 1) % n].map(|k| outline.points[k]);
        let across = (b - a).perp_dot(d - c);
        let t =
            if across == 0.0 { 1.0 } else { ((c - a).perp_dot(d - c) / across).clamp(0.0, 1.0) };
        let meeting = a.lerp(b, t);
        // Neighbours that fold back on each other have no loop between them, but a corner too many.
        let kept = (j > i + 1).then_some(meeting);
        let gone = j - i - usize::from(kept.is_some());
        outline.points.splice(i + 1..=j, kept);
        let moved = |vertex: usize| if vertex > j { vertex - gone } else { vertex };
        outline.apex = moved(outline.apex);
        outline.landmarks.retain(|mark| mark.vertex <= i || mark.vertex > j);
        outline.landmarks.iter_mut().for_each(|mark| mark.vertex = moved(mark.vertex));
    }
}
