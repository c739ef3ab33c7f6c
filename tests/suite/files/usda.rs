//! The card in USD, read as text; by Pixar's library where it is installed:
//! `VENATION_USD=/path/to/python cargo test --test suite -- --ignored usd`.

use std::process::Command;

use venation::io::write::{Overwrite, write_files};
use venation::io::{LeafFiles, MapKind, encode_leaf};
use venation::spec::{CardShape, Output};

use super::{SmallLeaf, everything, text_of};

#[test]
fn the_stage_is_in_metres_and_cut_out_by_a_threshold() {
    let leaf = SmallLeaf::new("2nd oak");
    let files = leaf.encoded();
    let text = text_of(&files, "2nd_oak.usda");
    for needed in [
        "#usda 1.0\n",
        "defaultPrim = \"_2nd_oak\"",
        "metersPerUnit = 1\n",
        "upAxis = \"Y\"",
        "def Xform \"_2nd_oak\"",
    ] {
        assert!(text.contains(needed), "{needed}");
    }
    assert_eq!(text.matches("float inputs:opacityThreshold = 0.5").count(), 2);
    assert_eq!(text.matches("float4 inputs:scale = (2, 2, 2, 1)").count(), 2);
    assert_eq!(text.matches("float4 inputs:bias = (-1, -1, -1, 0)").count(), 2);
    // Colour is the only sRGB picture of a side, and opacity comes from the same one.
    assert_eq!(text.matches("sourceColorSpace = \"sRGB\"").count(), 2);
    assert_eq!(text.matches("baseColour.outputs:a>").count(), 2);
    for path in text.split("@./").skip(1).filter_map(|rest| rest.split('@').next()) {
        assert!(files.iter().any(|(name, _)| name == path), "{path}");
    }
    let brackets =
        |open: char, close: char| text.matches(open).count() == text.matches(close).count();
    assert!(brackets('{', '}') && brackets('(', ')') && brackets('[', ']'));
}

#[test]
fn maps_that_are_not_written_are_not_named() {
    let leaf = SmallLeaf::new("oak");
    let output = Output { maps: vec![MapKind::Height], ..everything() };
    let files = encode_leaf(&LeafFiles { output: &output, ..leaf.files() });
    let text = text_of(&files, "oak.usda");
    assert!(!text.contains("@./"), "{text}");
    assert_eq!(text.matches("float inputs:roughness = 0.").count(), 2);
}

const SCRIPT: &str = r#"
import sys
from pxr import Sdf, Usd, UsdGeom, UsdShade, UsdValidation
stage = Usd.Stage.Open(sys.argv[1])
assert UsdGeom.GetStageMetersPerUnit(stage) == 1 and UsdGeom.GetStageUpAxis(stage) == "Y"
validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
errors = UsdValidation.ValidationContext(validators).Validate(stage)
assert not errors, [(e.GetName(), e.GetMessage()) for e in errors]
root = stage.GetDefaultPrim().GetPath()
for side in ("front", "back"):
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath(root.AppendChild(side)))
    assert UsdGeom.Mesh.ComputeExtent(mesh.GetPointsAttr().Get()) == mesh.GetExtentAttr().Get()
    material, _ = UsdShade.MaterialBindingAPI(mesh).ComputeBoundMaterial()
    surface = material.ComputeSurfaceSource()[0]
    assert surface.GetIdAttr().Get() == "UsdPreviewSurface"
    source = surface.GetInput("opacity").GetConnectedSources()[0][0]
    assert source.sourceName == "a"
    assert UsdShade.Shader(source.source.GetPrim()).GetInput("file").Get().resolvedPath
print("good")
"#;

#[test]
#[ignore = "needs PyPI's usd-core: set VENATION_USD to a Python that has it"]
fn usd_opens_and_validates_the_stage() {
    let python = std::env::var("VENATION_USD").expect("VENATION_USD names a Python with usd-core");
    let leaf = SmallLeaf::new("oak");
    for card in [CardShape::Square, CardShape::Outline] {
        let output = Output { card, ..everything() };
        let files = encode_leaf(&LeafFiles { output: &output, ..leaf.files() });
        let folder = tempfile::tempdir().unwrap();
        write_files(folder.path(), &files, Overwrite::Refuse).unwrap();
        let path = folder.path().join("oak.usda");
        let run = Command::new(&python).args(["-c", SCRIPT]).arg(path).output().unwrap();
        let said = String::from_utf8_lossy(&run.stdout);
        assert!(said.contains("good"), "{}", String::from_utf8_lossy(&run.stderr));
    }
}
