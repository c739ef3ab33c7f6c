//! The leaf as a card in Universal Scene Description, as text, with `UsdPreviewSurface`.
//!
//! Colour and opacity come from one picture, as the surface's specification asks; opacity is a
//! threshold of 0.5, so the blade is cut out and not blended. Data maps are read `raw`; normals
//! are spread from 0–1 to −1–1 by scale and bias. The surface knows no light from behind: the
//! translucency map stays beside the file. Normals are those of OpenGL, whatever the maps beside it.
//!
//! Source: Pixar, "UsdPreviewSurface Specification". Units are metres, y up.

use std::fmt::Write as _;

use super::card::{Card, Corner, MapPaths, Side};
use super::decimal::decimal;

/// Of a metre, to a tenth of a micrometre.
const PLACES: usize = 7;

/// Opaque from this coverage on.
const OPACITY_THRESHOLD: f64 = 0.5;

/// The text of the file.
#[must_use]
pub fn usda(card: &Card<'_>, sides: &[MapPaths; 2]) -> String {
    let root = identifier(card.stem);
    let mut text = format!(
        "#usda 1.0\n(\n    defaultPrim = \"{root}\"\n    doc = \"{}\"\n    metersPerUnit = 1\n    \
         upAxis = \"Y\"\n)\n\ndef Xform \"{root}\" (\n    kind = \"component\"\n)\n{{\n",
        super::GENERATOR
    );
    for side in Side::ALL {
        mesh(&mut text, card, side, &root);
    }
    text.push_str("    def Scope \"Materials\"\n    {\n");
    for (side, paths) in Side::ALL.into_iter().zip(sides) {
        material(&mut text, card, side, paths, &root);
    }
    text.push_str("    }\n}\n");
    text
}

fn mesh(text: &mut String, card: &Card<'_>, side: Side, root: &str) {
    let (corners, triangles) = (card.corners(side), card.triangles(side));
    let low = bound(&corners, f64::min);
    let high = bound(&corners, f64::max);
    let facing = if side == Side::Front { 1 } else { -1 };
    let list = |items: Vec<String>| items.join(", ");
    let points = corners.iter().map(|c| tuple(&c.position)).collect();
    let uvs = corners.iter().map(|c| tuple(&c.uv)).collect();
    let counts = vec!["3".to_owned(); triangles.len()];
    let indices = triangles.iter().flatten().map(u32::to_string).collect();
    let word = side.word();
    let _ = write!(
        text,
        "    def Mesh \"{word}\" (\n        prepend apiSchemas = [\"MaterialBindingAPI\"]\n    )\n    \
         {{\n        uniform bool doubleSided = 1\n        float3[] extent = [{}, {}]\n        \
         int[] faceVertexCounts = [{}]\n        int[] faceVertexIndices = [{}]\n        \
         rel material:binding = </{root}/Materials/{word}>\n        normal3f[] normals = \
         [(0, 0, {facing})] (\n            interpolation = \"constant\"\n        )\n        \
         point3f[] points = [{}]\n        texCoord2f[] primvars:st = [{}] (\n            \
         interpolation = \"vertex\"\n        )\n        uniform token subdivisionScheme = \
         \"none\"\n    }}\n\n",
        tuple(&low),
        tuple(&high),
        list(counts),
        list(indices),
        list(points),
        list(uvs),
    );
}

fn bound(corners: &[Corner], pick: fn(f64, f64) -> f64) -> [f64; 3] {
    [0, 1, 2].map(|k| corners.iter().map(|c| c.position[k]).reduce(pick).unwrap_or(0.0))
}

fn material(text: &mut String, card: &Card<'_>, side: Side, paths: &MapPaths, root: &str) {
    let word = side.word();
    let place = format!("/{root}/Materials/{word}");
    let mut surface = String::from(
        "            def Shader \"surface\"\n            {\n                uniform token info:id = \
         \"UsdPreviewSurface\"\n                float inputs:ior = 1.45\n                \
         float inputs:metallic = 0\n                int inputs:useSpecularWorkflow = 0\n",
    );
    let mut textures = String::new();
    let mut connect = |input: &str, kind: &str, name: &str, output: &str| {
        let _ = writeln!(
            surface,
            "                {kind} inputs:{input}.connect = <{place}/{name}.outputs:{output}>"
        );
    };
    if let Some(path) = &paths.base_colour {
        connect("diffuseColor", "color3f", "baseColour", "rgb");
        connect("opacity", "float", "baseColour", "a");
        texture(&mut textures, &place, "baseColour", path, "sRGB", Outputs::Rgba);
    }
    if let Some(path) = &paths.normal {
        connect("normal", "normal3f", "normal", "rgb");
        texture(&mut textures, &place, "normal", path, "raw", Outputs::Normal);
    }
    if let Some(path) = &paths.roughness {
        connect("roughness", "float", "roughness", "r");
        texture(&mut textures, &place, "roughness", path, "raw", Outputs::Red);
    }
    if let Some(path) = &paths.occlusion {
        connect("occlusion", "float", "occlusion", "r");
        texture(&mut textures, &place, "occlusion", path, "raw", Outputs::Red);
    }
    if paths.base_colour.is_some() {
        let _ = writeln!(
            surface,
            "                float inputs:opacityThreshold = {OPACITY_THRESHOLD}"
        );
    }
    if paths.roughness.is_none() {
        let roughness = decimal(card.microfacet_roughness(side), PLACES);
        let _ = writeln!(surface, "                float inputs:roughness = {roughness}");
    }
    surface.push_str("                token outputs:surface\n            }\n\n");
    let _ = write!(
        text,
        "        def Material \"{word}\"\n        {{\n            token outputs:surface.connect = \
         <{place}/surface.outputs:surface>\n\n{surface}            def Shader \"st\"\n            {{\n                \
         uniform token info:id = \"UsdPrimvarReader_float2\"\n                \
         string inputs:varname = \"st\"\n                float2 outputs:result\n            }}\n\n\
         {textures}        }}\n\n"
    );
}

/// What a picture gives.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Outputs {
    Rgba,
    Normal,
    Red,
}

fn texture(text: &mut String, place: &str, name: &str, path: &str, space: &str, outputs: Outputs) {
    let _ = write!(
        text,
        "            def Shader \"{name}\"\n            {{\n                uniform token info:id = \
         \"UsdUVTexture\"\n                asset inputs:file = @./{path}@\n                \
         token inputs:sourceColorSpace = \"{space}\"\n                \
         float2 inputs:st.connect = <{place}/st.outputs:result>\n                \
         token inputs:wrapS = \"clamp\"\n                token inputs:wrapT = \"clamp\"\n"
    );
    if outputs == Outputs::Normal {
        text.push_str(
            "                float4 inputs:scale = (2, 2, 2, 1)\n                \
             float4 inputs:bias = (-1, -1, -1, 0)\n",
        );
    }
    text.push_str(match outputs {
        Outputs::Rgba => "                float3 outputs:rgb\n                float outputs:a\n",
        Outputs::Normal => "                float3 outputs:rgb\n",
        Outputs::Red => "                float outputs:r\n",
    });
    text.push_str("            }\n\n");
}

/// A name as USD takes it: letters, digits and `_`, no digit first.
fn identifier(stem: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let name: String = stem.chars().map(plain).collect();
    if name.starts_with(|c: char| c.is_ascii_digit()) { format!("_{name}") } else { name }
}

fn tuple(numbers: &[f64]) -> String {
    let numbers: Vec<String> = numbers.iter().map(|&x| decimal(x, PLACES)).collect();
    format!("({})", numbers.join(", "))
}
