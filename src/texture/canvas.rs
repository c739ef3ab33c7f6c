//! The memory of pictures that nobody looks at any more, to paint the next ones on.
//!
//! A system hands out memory page by page where it is first written to, and takes it back with large pictures:
//! of painting four maps of both sides at 4096² that is a quarter.

use super::TextureSet;
use super::map::MapSet;
use super::side::SideMaps;

/// What is left of a painted leaf when its pictures have been written: [`Easel`](super::Easel) and
/// [`pipeline::Painter`](crate::pipeline::Painter) paint on it. Pictures of another size, or of maps that it has not,
/// take memory of their own.
#[derive(Debug, Default)]
pub struct Canvas {
    sides: Option<Box<[SideMaps; 2]>>,
}

impl From<TextureSet> for Canvas {
    fn from(set: TextureSet) -> Self {
        Self { sides: Some(Box::new([set.front, set.back])) }
    }
}

impl Canvas {
    /// Both sides with anything on them, to be painted on everywhere.
    pub(super) fn take(&mut self, size: usize, maps: MapSet) -> [SideMaps; 2] {
        let used = self.sides.take().map(|sides| sides.map(Some));
        used.unwrap_or_default().map(|side| SideMaps::unpainted(side, size, maps))
    }
}
