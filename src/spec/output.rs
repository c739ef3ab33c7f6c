//! What is written of a leaf: maps, formats, and how they are named and drawn.

use crate::parameter::{parameters, words};

words! {
    /// A form of the leaf other than pictures.
    pub enum FormatKind {
        /// A textured card.
        Obj = "obj",
        /// A textured card in one binary file.
        Glb = "glb",
        /// A textured card as text.
        Usda = "usda",
        /// Outline and veins as vectors.
        Svg = "svg",
        /// Outline and veins for cutters.
        Dxf = "dxf",
        /// The vein graph.
        Json = "json",
        /// The vein graph for networkx, Gephi, igraph.
        GraphMl = "graphml",
        /// Tables of nodes, edges and areoles.
        Csv = "csv",
    }
}

impl FormatKind {
    /// The formats that are written unless others are asked for.
    pub const DEFAULT: &'static [Self] = &[Self::Obj];
}

words! {
    /// The sheet that a card's pictures lie on.
    pub enum CardShape {
        /// The square of the textures.
        Square = "square",
        /// A few dozen corners around the leaf: hardly a texel is drawn for nothing.
        Outline = "outline",
    }
}

words! {
    /// What the lines of an SVG are for.
    pub enum SvgStyle {
        /// To look at: veins as wide as they are.
        Print = "print",
        /// A pen of its own width: single lines, each as long as it goes on.
        Plotter = "plotter",
        /// Hairlines, red to cut through and blue to score.
        Laser = "laser",
    }
}

words! {
    /// Whose names and packing the maps follow.
    pub enum Profile {
        /// Names that Blender's Node Wrangler and most importers sort by.
        Default = "default",
        /// `T_name_BC`, `_N` (DirectX), `_ORM`.
        Unreal = "unreal",
        /// `_BaseMap`, `_Normal`, `_MaskMap`.
        UnityHdrp = "unity-hdrp",
        /// `_diff`, `_nor_gl`, `_disp`, `_arm`, names in small letters.
        PolyHaven = "polyhaven",
        /// `_Color`, `_NormalGL`, `_NormalDX`, `_Displacement`.
        AmbientCg = "ambientcg",
        /// `_Color`, `_Normal`, `_Gloss`, `_SubsurfaceColor`.
        SpeedTree = "speedtree",
    }
}

parameters! {
    /// What is written of a leaf.
    pub struct OutputSpec {
        /// Maps to write of each side: some of basecolor, opacity, height, normal, bump; or all, or none.
        maps: text("basecolor,opacity,height,normal"),
        /// Other files to write: some of obj, glb, usda, svg, dxf, json, graphml, csv; or all, or none.
        formats: text("obj"),
        /// Whose names and packing the maps follow.
        profile: choice(Profile, Profile::Default),
        /// The sheet of the cards in obj, glb and usda.
        card: choice(CardShape, CardShape::Square),
        /// What the lines of the svg are for.
        svg_style: choice(SvgStyle, SvgStyle::Print),
        /// Veins narrower than this are left out of svg and dxf: no cutter or pen could keep them.
        least_width_mm: number(0.0, 0.0..=100.0, "mm"),
    }
}
