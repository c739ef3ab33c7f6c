//! Margins given as polygons: settings to outlines, and margins to settings.

use glam::DVec2;

use super::{Landmark, LandmarkKind, Margin, MarginKind, MarginSpec, Outline};

impl MarginSpec {
    /// The same with its polygon in millimetres: scaled so that the apex stands at `length_mm`.
    #[must_use]
    pub fn at_length(&self) -> Self {
        let mut spec = self.clone();
        let given: Vec<DVec2> = self.polygon_mm.iter().map(|p| DVec2::from(*p)).collect();
        let apex = apex_vertex(&given);
        let scale = scale_to(given.get(apex).map_or(0.0, |tip| tip.y), self.length_mm);
        if self.kind == MarginKind::Polygon && scale != 1.0 {
            let lines = [&mut spec.cuts_mm, &mut spec.tooth_tips_mm, &mut spec.lobe_veins_mm];
            let points = lines.into_iter().flatten().flatten();
            for p in spec.polygon_mm.iter_mut().chain(points) {
                *p = p.map(|x| x * scale);
            }
            spec.polygon_mm[apex][1] = self.length_mm;
        }
        spec
    }

    /// The polygon as an outline with what the settings know of it.
    pub(super) fn given_outline(&self) -> Outline {
        let spec = self.at_length();
        let vector = |p: &[f64; 2]| DVec2::from(*p);
        let points: Vec<DVec2> = spec.polygon_mm.iter().map(vector).collect();
        let cuts = spec.cuts_mm.iter().map(|line| line.iter().map(vector).collect()).collect();
        let landmarks = spec.polygon_landmarks(&points);
        Outline { apex: apex_vertex(&points), points, cuts, landmarks }
    }

    /// What the settings know of a polygon: each at the vertex nearest to it.
    fn polygon_landmarks(&self, outline: &[DVec2]) -> Vec<Landmark> {
        let nearest = |p: &[f64; 2]| {
            let far = |i: &usize| outline[*i].distance_squared(DVec2::from(*p));
            (0..outline.len()).min_by(|i, j| far(i).total_cmp(&far(j)))
        };
        let orders = self.tooth_tips_mm.iter().zip(1_u8..);
        let teeth = orders
            .flat_map(|(tips, order)| tips.iter().map(move |p| (p, LandmarkKind::Tooth { order })));
        let lobes = self.lobe_veins_mm.iter().filter_map(|vein| match &vein[..] {
            [origin, tip] => Some((tip, LandmarkKind::LobeTip { origin: DVec2::from(*origin) })),
            _ => None,
        });
        let all = teeth.chain(lobes);
        all.filter_map(|(p, kind)| Some(Landmark { vertex: nearest(p)?, kind })).collect()
    }

    /// A margin as a polygon with the landmarks that veins read.
    #[must_use]
    pub fn of_margin(margin: &Margin) -> Self {
        let point = |p: DVec2| [p.x, p.y];
        let mut tips: Vec<Vec<[f64; 2]>> = Vec::new();
        let mut lobes = Vec::new();
        for &Landmark { vertex, kind } in margin.landmarks() {
            let at = margin.outline()[vertex];
            match kind {
                LandmarkKind::Tooth { order } => {
                    let order = usize::from(order.max(1));
                    tips.resize(tips.len().max(order), Vec::new());
                    tips[order - 1].push(point(at));
                }
                LandmarkKind::LobeTip { origin } => lobes.push(vec![point(origin), point(at)]),
                _ => {}
            }
        }
        Self {
            kind: MarginKind::Polygon,
            length_mm: margin.length_mm(),
            polygon_mm: margin.outline().iter().copied().map(point).collect(),
            cuts_mm: margin.cuts().iter().map(|l| l.iter().copied().map(point).collect()).collect(),
            tooth_tips_mm: tips,
            lobe_veins_mm: lobes,
            ..Self::default()
        }
    }
}

/// What brings a polygon of one length to another; 1 for one that is not placed.
fn scale_to(from_mm: f64, to_mm: f64) -> f64 {
    let scale = to_mm / from_mm;
    if from_mm > 0.0 && scale.is_finite() && scale > 0.0 { scale } else { 1.0 }
}

/// The vertex on the +y axis that lies highest: where a placed polygon has its apex.
fn apex_vertex(outline: &[DVec2]) -> usize {
    let on_axis = |p: &DVec2| p.x.abs() <= 1e-9 * p.y.abs().max(1.0);
    (0..outline.len())
        .filter(|&i| on_axis(&outline[i]))
        .max_by(|&i, &j| outline[i].y.total_cmp(&outline[j].y))
        .unwrap_or(0)
}
