//! (stub)
use std::path::Path;
#[derive(Debug, Clone, Copy)]
pub enum OutlineKind {
    Auto,
    Sketch,
    Photo,
    Polygon,
}
#[derive(Debug, Clone)]
pub struct OutlineOptions {
    pub kind: OutlineKind,
    pub root: Option<[f64; 2]>,
    pub y_up: bool,
    pub length_mm: f64,
}
pub struct ImportedOutline {
    pub polygon_mm: Vec<[f64; 2]>,
    pub cuts_mm: Vec<Vec<[f64; 2]>>,
    pub notes: Vec<String>,
}
pub fn import(_: &Path, _: &OutlineOptions) -> Result<ImportedOutline, String> {
    Err("stub".into())
}
pub fn read_points(_: &Path) -> Result<Vec<[f64; 2]>, String> {
    Err("stub".into())
}
