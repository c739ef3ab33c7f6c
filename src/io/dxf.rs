//! Outline and veins for cutters and drawing programs: DXF, release 2000, as text.
//!
//! Lengths are millimetres, and `$INSUNITS` says so: without it every program guesses. The outline is
//! a closed `LWPOLYLINE` on the layer CUT, slits are open ones there; every order of veins has a layer
//! of its own, a vein one line as long as it goes on. No line is drawn twice. Leaf space stands
//! as it is: base of the blade at the origin, apex on +y.
//!
//! Source: Autodesk, "DXF Reference", groups of AutoCAD 2000: the tables, blocks and the dictionary
//! that strict readers want are there, with nothing in them that depends on day or machine.

use std::fmt::Write as _;

use glam::DVec2;

use super::drawing::{Cut, Piece, number, order_name, pieces};
use crate::geometry::Rect;
use crate::margin::Margin;
use crate::veins::Venation;

/// `$INSUNITS`: 4 is the millimetre.
const MILLIMETRES: u32 = 4;

/// Colours as AutoCAD numbers them, by layer: red to cut, then blue, green, magenta, cyan, grey.
const COLOURS: [u32; 6] = [1, 5, 3, 6, 4, 8];

/// Handles of the objects that stand in every file.
mod handle {
    pub(super) const MODEL: u32 = 0x1f;
    pub(super) const PAPER: u32 = 0x1b;
    pub(super) const ROOT: u32 = 0xc;
    pub(super) const GROUPS: u32 = 0xd;
    /// The first that is free.
    pub(super) const FREE: u32 = 0x100;
}

/// The drawing of a leaf; `rings` outline what is left of a damaged blade. Veins narrower than
/// `least_width_mm` are left out.
#[must_use]
pub fn dxf(
    margin: &Margin,
    venation: &Venation,
    rings: &[Vec<DVec2>],
    least_width_mm: f64,
) -> String {
    let pieces = pieces(venation, Cut { by_width: false, least_width_mm });
    let orders = pieces.iter().map(|piece| piece.order).max().unwrap_or(0);
    let layers: Vec<String> =
        std::iter::once("CUT".to_owned()).chain((1..=orders).map(vein_layer)).collect();
    let mut out = Dxf { text: String::new(), next: handle::FREE };
    let bounds = Rect::around(margin.outline().iter().copied());

    // What is drawn comes first, for the header names the next free handle.
    let mut entities = Dxf { text: String::new(), next: handle::FREE };
    // Of a damaged blade what is left, gaps as rings of their own.
    let whole = [margin.outline().to_vec()];
    for ring in if rings.is_empty() { &whole[..] } else { rings } {
        entities.polyline("CUT", ring, true);
    }
    for cut in margin.cuts() {
        entities.polyline("CUT", cut, false);
    }
    for Piece { order, points, .. } in &pieces {
        entities.polyline(&vein_layer(*order), points, false);
    }

    out.section("HEADER");
    out.groups(&[(9, "$ACADVER"), (1, "AC1015"), (9, "$HANDSEED")]);
    let seed = format!("{:X}", entities.next + layers.len() as u32 + 1);
    out.groups(&[(5, &seed), (9, "$INSUNITS"), (70, &MILLIMETRES.to_string())]);
    out.groups(&[(9, "$MEASUREMENT"), (70, "1"), (9, "$EXTMIN")]);
    out.point(bounds.min);
    out.group(9, "$EXTMAX");
    out.point(bounds.max);
    out.end_section();
    out.section("CLASSES");
    out.end_section();
    out.next = entities.next;
    out.tables(&layers);
    out.blocks();
    out.section("ENTITIES");
    out.text.push_str(&entities.text);
    out.end_section();
    out.objects();
    out.group(0, "EOF");
    out.text
}

fn vein_layer(order: u8) -> String {
    format!("VEINS_{}", order_name(order).to_uppercase().replace(' ', "_"))
}

/// Text of group codes and values, and the next free handle.
struct Dxf {
    text: String,
    next: u32,
}

impl Dxf {
    fn group(&mut self, code: u32, value: &str) {
        let _ = writeln!(self.text, "{code:3}\n{value}");
    }

    fn groups(&mut self, groups: &[(u32, &str)]) {
        for (code, value) in groups {
            self.group(*code, value);
        }
    }

    fn handle(&mut self, handle: u32) {
        self.group(5, &format!("{handle:X}"));
    }

    fn owner(&mut self, handle: u32) {
        self.group(330, &format!("{handle:X}"));
    }

    fn point(&mut self, p: DVec2) {
        self.groups(&[(10, &number(p.x)), (20, &number(p.y)), (30, "0")]);
    }

    fn section(&mut self, name: &str) {
        self.groups(&[(0, "SECTION"), (2, name)]);
    }

    fn end_section(&mut self) {
        self.group(0, "ENDSEC");
    }

    /// A line through points; those that print alike in succession stand once.
    fn polyline(&mut self, layer: &str, points: &[DVec2], closed: bool) {
        let mut printed: Vec<[String; 2]> =
            points.iter().map(|p| [number(p.x), number(p.y)]).collect();
        printed.dedup();
        if closed && printed.len() > 1 && printed.first() == printed.last() {
            printed.pop();
        }
        if printed.len() < 2 {
            return;
        }
        self.group(0, "LWPOLYLINE");
        self.handle(self.next);
        self.next += 1;
        self.owner(handle::MODEL);
        self.groups(&[(100, "AcDbEntity"), (8, layer), (100, "AcDbPolyline")]);
        self.group(90, &printed.len().to_string());
        self.groups(&[(70, if closed { "1" } else { "0" }), (43, "0")]);
        for [x, y] in &printed {
            self.groups(&[(10, x), (20, y)]);
        }
    }

    fn table(&mut self, name: &str, handle: u32, entries: usize) {
        self.groups(&[(0, "TABLE"), (2, name)]);
        self.handle(handle);
        self.owner(0);
        self.group(100, "AcDbSymbolTable");
        self.group(70, &entries.to_string());
    }

    fn entry(&mut self, kind: &str, handle: u32, table: u32, class: &str, name: &str) {
        self.group(0, kind);
        self.handle(handle);
        self.owner(table);
        self.groups(&[(100, "AcDbSymbolTableRecord"), (100, class), (2, name)]);
    }

    fn tables(&mut self, layers: &[String]) {
        self.section("TABLES");
        self.table("VPORT", 0x8, 0);
        self.group(0, "ENDTAB");
        self.table("LTYPE", 0x5, 3);
        for (handle, name) in [(0x14, "ByBlock"), (0x15, "ByLayer"), (0x16, "Continuous")] {
            self.entry("LTYPE", handle, 0x5, "AcDbLinetypeTableRecord", name);
            self.groups(&[(70, "0"), (3, ""), (72, "65"), (73, "0"), (40, "0")]);
        }
        self.group(0, "ENDTAB");
        self.table("LAYER", 0x2, layers.len() + 1);
        self.entry("LAYER", 0x10, 0x2, "AcDbLayerTableRecord", "0");
        self.groups(&[(70, "0"), (62, "7"), (6, "Continuous")]);
        for (i, layer) in layers.iter().enumerate() {
            let handle = self.next;
            self.next += 1;
            self.entry("LAYER", handle, 0x2, "AcDbLayerTableRecord", layer);
            let colour = COLOURS[i.min(COLOURS.len() - 1)].to_string();
            self.groups(&[(70, "0"), (62, &colour), (6, "Continuous")]);
        }
        self.group(0, "ENDTAB");
        self.table("STYLE", 0x3, 1);
        self.entry("STYLE", 0x11, 0x3, "AcDbTextStyleTableRecord", "Standard");
        self.groups(&[(70, "0"), (40, "0"), (41, "1"), (50, "0"), (71, "0"), (42, "1")]);
        self.groups(&[(3, "txt"), (4, "")]);
        self.group(0, "ENDTAB");
        self.table("VIEW", 0x6, 0);
        self.group(0, "ENDTAB");
        self.table("UCS", 0x7, 0);
        self.group(0, "ENDTAB");
        self.table("APPID", 0x9, 1);
        self.entry("APPID", 0x12, 0x9, "AcDbRegAppTableRecord", "ACAD");
        self.group(70, "0");
        self.group(0, "ENDTAB");
        self.table("DIMSTYLE", 0xa, 0);
        self.group(100, "AcDbDimStyleTable");
        self.group(0, "ENDTAB");
        self.table("BLOCK_RECORD", 0x1, 2);
        for (handle, name) in [(handle::MODEL, "*Model_Space"), (handle::PAPER, "*Paper_Space")] {
            self.entry("BLOCK_RECORD", handle, 0x1, "AcDbBlockTableRecord", name);
            self.owner_of_layout();
        }
        self.group(0, "ENDTAB");
        self.end_section();
    }

    /// Neither space has a layout of its own.
    fn owner_of_layout(&mut self) {
        self.group(340, "0");
    }

    fn blocks(&mut self) {
        self.section("BLOCKS");
        let blocks = [(handle::MODEL, "*Model_Space", 0x20), (handle::PAPER, "*Paper_Space", 0x1c)];
        for (record, name, first) in blocks {
            self.group(0, "BLOCK");
            self.handle(first);
            self.owner(record);
            self.groups(&[(100, "AcDbEntity"), (8, "0"), (100, "AcDbBlockBegin"), (2, name)]);
            self.group(70, "0");
            self.point(DVec2::ZERO);
            self.groups(&[(3, name), (1, ""), (0, "ENDBLK")]);
            self.handle(first + 1);
            self.owner(record);
            self.groups(&[(100, "AcDbEntity"), (8, "0"), (100, "AcDbBlockEnd")]);
        }
        self.end_section();
    }

    fn objects(&mut self) {
        self.section("OBJECTS");
        self.group(0, "DICTIONARY");
        self.handle(handle::ROOT);
        self.owner(0);
        self.groups(&[(100, "AcDbDictionary"), (281, "1"), (3, "ACAD_GROUP")]);
        self.group(350, &format!("{:X}", handle::GROUPS));
        self.group(0, "DICTIONARY");
        self.handle(handle::GROUPS);
        self.owner(handle::ROOT);
        self.groups(&[(100, "AcDbDictionary"), (281, "1")]);
        self.end_section();
    }
}
