//! A network to measure, from whatever holds one: the folder of a leaf, a vein graph, a picture.

use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

use super::graph::{GraphError, VeinDocument};
use super::mask::{self, MaskError};
use crate::veins::metrics::measures::Unit;
use crate::veins::metrics::{Network, picture};

/// A network and where it comes from.
#[derive(Debug, Clone)]
pub struct ReadNetwork {
    /// The veins.
    pub network: Network,
    /// Unit of their lengths.
    pub unit: Unit,
    /// The file that was read.
    pub path: PathBuf,
    /// Side of a pixel, in the unit, for a network from a picture.
    pub pixel: Option<f64>,
    /// What the reader should know.
    pub notes: Vec<String>,
}

/// Why a network could not be read.
#[derive(Debug, thiserror::Error)]
#[error("{}: {problem}", path.display())]
pub struct NetworkError {
    /// The file or folder.
    pub path: PathBuf,
    /// What is wrong.
    pub problem: NetworkProblem,
}

/// What is wrong with a file or folder, to stand after its name.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NetworkProblem {
    /// The system refused.
    #[error("{0}")]
    Read(#[from] std::io::Error),
    /// A folder without a vein graph.
    #[error("holds no NAME{GRAPH_ENDING}; generate with --format json")]
    NoGraph,
    /// A folder with several.
    #[error("holds {0} files *{GRAPH_ENDING}; name one")]
    ManyGraphs(usize),
    /// Nothing in it.
    #[error("is empty")]
    Empty,
    /// Called a picture, and none.
    #[error("is not a PNG or JPEG picture, whatever its name says")]
    NoPicture,
    /// More text than can be read.
    #[error("is larger than {} megabytes", MOST_BYTES >> 20)]
    TooLarge,
    /// Bytes of another kind.
    #[error("is neither a vein graph (JSON) nor a picture (PNG, JPEG)")]
    Unknown,
    /// A picture of something else.
    #[error("has no lines that could be veins")]
    NoLines,
    /// A picture that cannot be measured.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// A vein graph that makes no sense.
    #[error(transparent)]
    Graph(#[from] GraphError),
}

/// What the files of vein graphs end in.
const GRAPH_ENDING: &str = "_veins.json";

/// Vein graphs may have this many bytes: some ten million nodes.
const MOST_BYTES: u64 = 1 << 30;

/// Whether a file can be read and begins as the pictures do that [`read`] reads.
#[must_use]
pub fn is_picture(path: &Path) -> bool {
    path.is_file() && head(path).is_ok_and(|head| mask::is_picture(&head))
}

/// Reads a leaf folder with a `NAME_veins.json`, such a file, or a black-and-white picture; a
/// picture has lengths in pixels unless it is known how many go to the millimetre.
///
/// # Errors
///
/// [`NetworkError`] names the file and what is wrong with it.
pub fn read(path: &Path, pixels_per_mm: Option<f64>) -> Result<ReadNetwork, NetworkError> {
    let fail = |path: &Path, problem| NetworkError { path: path.to_owned(), problem };
    let file = match path.is_dir() {
        true => graph_in(path).map_err(|problem| fail(path, problem))?,
        false => path.to_owned(),
    };
    read_file(&file, pixels_per_mm).map_err(|problem| fail(&file, problem))
}

fn read_file(path: &Path, pixels_per_mm: Option<f64>) -> Result<ReadNetwork, NetworkProblem> {
    let head = head(path)?;
    let path = path.to_owned();
    if mask::is_picture(&head) {
        let mask = mask::read(&path)?;
        let pixel = pixels_per_mm.map_or(1.0, |per_mm| 1.0 / per_mm);
        let unit = if pixels_per_mm.is_some() { Unit::Millimetre } else { Unit::Pixel };
        let mut notes = Vec::new();
        if mask.dark_veins {
            notes.push("the dark parts are taken for veins, as the border is bright".to_owned());
        }
        let network = picture::network(mask.veins, pixel);
        if network.segments().is_empty() {
            return Err(NetworkProblem::NoLines);
        }
        return Ok(ReadNetwork { network, unit, path, pixel: Some(pixel), notes });
    }
    if head.is_empty() {
        return Err(NetworkProblem::Empty);
    }
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    if matches!(&*ending, "png" | "jpg" | "jpeg") {
        return Err(NetworkProblem::NoPicture);
    }
    let read = VeinDocument::from_json(&text(&path)?)?.graph()?;
    let network = Network::of_graph(&read.graph, &read.radii, &read.orders, &read.outline);
    let mut notes = Vec::new();
    if read.outline.is_empty() {
        notes.push("the file has no margin: the blade is drawn around the veins".to_owned());
    }
    Ok(ReadNetwork { network, unit: Unit::Millimetre, path, pixel: None, notes })
}

fn graph_in(folder: &Path) -> Result<PathBuf, NetworkProblem> {
    let entries = fs::read_dir(folder)?;
    let mut graphs: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.to_string_lossy().ends_with(GRAPH_ENDING))
        .collect();
    graphs.sort();
    match graphs.len() {
        1 => Ok(graphs.remove(0)),
        0 => Err(NetworkProblem::NoGraph),
        n => Err(NetworkProblem::ManyGraphs(n)),
    }
}

fn head(path: &Path) -> std::io::Result<Vec<u8>> {
    let mut head = Vec::new();
    File::open(path)?.take(16).read_to_end(&mut head)?;
    Ok(head)
}

fn text(path: &Path) -> Result<String, NetworkProblem> {
    let mut text = String::new();
    let file = File::open(path)?;
    let read = file.take(MOST_BYTES + 1).read_to_string(&mut text);
    match read {
        Ok(bytes) if bytes as u64 > MOST_BYTES => Err(NetworkProblem::TooLarge),
        Ok(_) => Ok(text),
        Err(error) if error.kind() == std::io::ErrorKind::InvalidData => {
            Err(NetworkProblem::Unknown)
        }
        Err(error) => Err(error.into()),
    }
}
