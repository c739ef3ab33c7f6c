//! The blades in a picture, listed.

use rayon::prelude::*;
use serde_json::{Value, json};
use venation::geometry::compact::CompactCurve;
use venation::io::{outline, silhouettes};
use venation::margin::blades::{Blade, Blades};

use super::super::{Context, Failure};
use super::Args;

pub(super) fn run(args: &Args, context: &mut Context<'_>) -> Result<(), Failure> {
    let found = outline::blades(&args.path).map_err(|error| Failure::Input(error.to_string()))?;
    let path = args.path.display();
    found.notes.iter().for_each(|note| context.say(&format!("{path}: {note}")));
    let curves: Vec<CompactCurve> =
        found.blades.par_iter().map(|blade| blade.silhouette(args.tolerance)).collect();
    if let Some(file) = &args.silhouettes {
        super::super::refuse_existing([file], args.force)?;
        super::super::save(file, silhouettes::svg(&curves, args.px_per_mm).into_bytes())?;
    }
    let scale = Scale {
        per_unit: args.px_per_mm.unwrap_or(1.0),
        unit: if args.px_per_mm.is_some() { "mm" } else { "px" },
    };
    let text = if args.json {
        let document = json!({
            "version": env!("CARGO_PKG_VERSION"),
            "path": args.path.to_string_lossy(),
            "unit": scale.unit,
            "blades": found.blades.iter().zip(&curves).map(|(b, c)| scale.json(b, c)).collect::<Vec<_>>(),
            "rectangle_areas": found.rectangles.iter().map(|a| scale.area(*a)).collect::<Vec<_>>(),
        });
        serde_json::to_string_pretty(&document).expect("plain data") + "\n"
    } else if args.csv {
        scale.csv(&found, &curves)
    } else {
        scale.table(&path.to_string(), &found, &curves)
    };
    write!(context.stdout, "{text}")?;
    Ok(())
}

/// What lengths are printed in.
struct Scale {
    /// Pixels to the unit.
    per_unit: f64,
    unit: &'static str,
}

impl Scale {
    fn length(&self, pixels: f64) -> f64 {
        pixels / self.per_unit
    }

    fn area(&self, pixels: f64) -> f64 {
        pixels / (self.per_unit * self.per_unit)
    }

    fn json(&self, blade: &Blade, curve: &CompactCurve) -> Value {
        let middle = blade.outline.iter().sum::<glam::DVec2>() / blade.outline.len() as f64;
        json!({
            "area": self.area(blade.area),
            "length": self.length(blade.length),
            "width": self.length(blade.width),
            "base_to_apex": blade.base_to_apex.map(|length| self.length(length)),
            "holes": blade.holes,
            "hole_area": self.area(blade.hole_area),
            "cut_by_border": blade.is_cut,
            "middle_px": [middle.x, middle.y],
            "boundary_points": blade.outline.len(),
            "control_points": curve.control_points(),
            "corners": curve.corners().count(),
            "curve_error": self.length(curve.deviation()),
        })
    }

    fn csv(&self, found: &Blades, curves: &[CompactCurve]) -> String {
        let mut text = format!(
            "blade,area_{0}2,length_{0},width_{0},base_to_apex_{0},holes,hole_area_{0}2,cut,control_points,corners,curve_error_{0}\n",
            self.unit
        );
        for (i, (blade, curve)) in found.blades.iter().zip(curves).enumerate() {
            text += &format!(
                "{},{},{},{},{},{},{},{},{},{},{}\n",
                i + 1,
                self.area(blade.area),
                self.length(blade.length),
                self.length(blade.width),
                blade.base_to_apex.map_or(String::new(), |l| self.length(l).to_string()),
                blade.holes,
                self.area(blade.hole_area),
                blade.is_cut,
                curve.control_points(),
                curve.corners().count(),
                self.length(curve.deviation()),
            );
        }
        text
    }

    fn table(&self, path: &str, found: &Blades, curves: &[CompactCurve]) -> String {
        let unit = self.unit;
        let count = found.blades.len();
        let mut text = format!(
            "{path}\n{count} blade{}\n\n{:>5}  {:>11}  {:>9}  {:>9}  {:>12}  {:>5}  {:>11}  {:>6}  {:>8}\n",
            if count == 1 { "" } else { "s" },
            "blade",
            format!("area {unit}²"),
            format!("length {unit}"),
            format!("width {unit}"),
            "base to apex",
            "holes",
            format!("holes {unit}²"),
            "points",
            format!("error {unit}"),
        );
        for (i, (blade, curve)) in found.blades.iter().zip(curves).enumerate() {
            let base_to_apex =
                blade.base_to_apex.map_or("-".to_owned(), |l| format!("{:.2}", self.length(l)));
            text += &format!(
                "{:>5}  {:>11.2}  {:>9.2}  {:>9.2}  {base_to_apex:>12}  {:>5}  {:>11.2}  {:>6}  {:>8.3}{}\n",
                i + 1,
                self.area(blade.area),
                self.length(blade.length),
                self.length(blade.width),
                blade.holes,
                self.area(blade.hole_area),
                curve.control_points(),
                self.length(curve.deviation()),
                if blade.is_cut { "  cut by the border" } else { "" },
            );
        }
        for area in &found.rectangles {
            text += &format!("rectangle left out: {:.2} {unit}²\n", self.area(*area));
        }
        text
    }
}
