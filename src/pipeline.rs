//! One leaf, all its stages in order: the only file that names them all.

use crate::error::Error;
use crate::growth::GrowingBlade;
use crate::margin::{self, Margin};
use crate::observer::Observer;
use crate::seed::Seed;
use crate::spec::LeafSpec;
use crate::texture::{Canvas, Easel, Paint, TextureSet};
use crate::veins::{self, Venation};

/// A blade with its veins, not painted yet.
#[derive(Debug, Clone)]
pub struct Grown {
    /// The outline: the mature one, or a bud's when `growth.scale` is below 1.
    pub margin: Margin,
    /// The veins in it.
    pub venation: Venation,
}

/// A finished leaf.
#[derive(Debug, Clone)]
pub struct Leaf {
    /// What it was made from.
    pub spec: LeafSpec,
    /// The seed of everything random in it.
    pub seed: Seed,
    /// Its blade and veins.
    pub grown: Grown,
    /// Its pictures.
    pub textures: TextureSet,
}

/// Builds the margin and grows the veins.
///
/// # Errors
///
/// The first stage's that fails.
pub fn grow(spec: &LeafSpec, seed: Seed, observer: &mut dyn Observer) -> Result<Grown, Error> {
    let margin = margin::build(&spec.margin, seed)?;
    let blade = GrowingBlade::new(margin, &spec.growth)?;
    let venation = veins::grow(&spec.veins, &blade, seed, observer)?;
    Ok(Grown { margin: blade.finished().clone(), venation })
}

/// Paints a grown leaf under one spec after another: a slider, a film, all sizes of a leaf. See [`Easel`].
#[derive(Debug)]
pub struct Painter<'a>(Easel<'a>);

impl<'a> Painter<'a> {
    /// For a leaf that has grown from this seed.
    #[must_use]
    pub fn new(grown: &'a Grown, seed: Seed) -> Self {
        Self(Easel::new(&grown.margin, &grown.venation, seed))
    }

    /// Lays down pictures that nobody looks at any more, of this leaf or of another: the next ones are painted over
    /// them.
    pub fn take_back(&mut self, canvas: impl Into<Canvas>) {
        self.0.take_back(canvas);
    }

    /// Paints the leaf: the same bytes as [`paint`].
    ///
    /// # Errors
    ///
    /// [`Error::Texture`].
    pub fn paint(
        &mut self,
        spec: &LeafSpec,
        observer: &mut dyn Observer,
    ) -> Result<TextureSet, Error> {
        Ok(self.0.paint(&settings(spec)?, observer)?)
    }
}

/// Paints a grown leaf.
///
/// # Errors
///
/// [`Error::Texture`].
pub fn paint(
    spec: &LeafSpec,
    grown: &Grown,
    seed: Seed,
    observer: &mut dyn Observer,
) -> Result<TextureSet, Error> {
    Painter::new(grown, seed).paint(spec, observer)
}

/// What painting reads of a spec.
fn settings(spec: &LeafSpec) -> Result<Paint<'_>, Error> {
    Ok(Paint {
        texture: &spec.texture,
        petiole: &spec.petiole,
        colour: &spec.colour,
        state: &spec.state,
        damage: &spec.damage,
        relief: &spec.relief,
        maps: spec.output.resolve()?.planes(),
        // A tenth of the auxin spawn rate (Foster, appendix B.3).
        default_speckles: (spec.veins.spawn_rate / 10.0).round() as u64,
    })
}

/// Makes a whole leaf.
///
/// # Errors
///
/// The first stage's that fails.
pub fn generate(spec: &LeafSpec, seed: Seed, observer: &mut dyn Observer) -> Result<Leaf, Error> {
    generate_with(spec, seed, Canvas::default, observer)
}

/// Makes a whole leaf, painted over pictures that nobody looks at any more; `canvas` is asked for them when it has
/// grown.
///
/// # Errors
///
/// The first stage's that fails.
pub fn generate_with(
    spec: &LeafSpec,
    seed: Seed,
    canvas: impl FnOnce() -> Canvas,
    observer: &mut dyn Observer,
) -> Result<Leaf, Error> {
    let grown = grow(spec, seed, observer)?;
    let mut painter = Painter::new(&grown, seed);
    painter.take_back(canvas());
    let textures = painter.paint(spec, observer)?;
    Ok(Leaf { spec: spec.clone(), seed, grown, textures })
}
