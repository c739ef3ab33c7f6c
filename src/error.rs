//! Why a leaf could not be made: the errors of the stages, gathered.

/// Why a leaf could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Its description is wrong.
    #[error(transparent)]
    Document(#[from] crate::document::DocumentError),
    /// It has no usable outline.
    #[error(transparent)]
    Margin(#[from] crate::margin::MarginError),
    /// Its growth makes no sense.
    #[error(transparent)]
    Growth(#[from] crate::growth::GrowthError),
    /// Its veins could not grow.
    #[error(transparent)]
    Veins(#[from] crate::veins::VeinError),
    /// It is not known what to write of it.
    #[error(transparent)]
    Output(#[from] crate::spec::OutputError),
    /// It could not be painted.
    #[error(transparent)]
    Texture(#[from] crate::texture::TextureError),
}
