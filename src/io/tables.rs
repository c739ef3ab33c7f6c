//! The vein graph as tables, for R and spreadsheets: units in the header row, a point for decimals.

use std::fmt::Write as _;

use super::graph::rounded;
use super::graphml;
use crate::margin::Margin;
use crate::parameter::words;
use crate::veins::metrics::Network;
use crate::veins::metrics::areoles::Areoles;
use crate::veins::{NodeId, Venation};

words! {
    /// A table of a leaf.
    pub enum Table {
        /// A vein node to the line.
        Nodes = "nodes",
        /// An edge to the line.
        Edges = "edges",
        /// An areole to the line.
        Areoles = "areoles",
    }
}

impl Table {
    /// What is in it, for people.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::Nodes => "vein nodes: place, parent, radius, order",
            Self::Edges => "edges of the vein graph, loops included",
            Self::Areoles => "areoles, the areas closed in by veins",
        }
    }

    /// The table of a leaf.
    #[must_use]
    pub fn csv(self, margin: &Margin, venation: &Venation) -> String {
        match self {
            Self::Nodes => nodes(venation),
            Self::Edges => edges(venation),
            Self::Areoles => {
                let (graph, outline) = (venation.graph(), margin.outline());
                let (radii, orders) = (venation.radii(), venation.orders());
                areoles(&Network::of_graph(graph, radii, orders, outline))
            }
        }
    }
}

fn nodes(venation: &Venation) -> String {
    let mut text = String::from("id,x_mm,y_mm,parent,radius_mm,order,kind\n");
    for (id, position) in venation.graph().positions().iter().enumerate() {
        let parent = venation.graph().parent(id as NodeId);
        let _ = writeln!(
            text,
            "{id},{},{},{},{},{},{}",
            rounded(position.x),
            rounded(position.y),
            parent.map(|parent| parent.to_string()).unwrap_or_default(),
            rounded(venation.radii()[id]),
            venation.orders()[id],
            venation.kind(id as NodeId),
        );
    }
    text
}

fn edges(venation: &Venation) -> String {
    let mut text = String::from("source,target,length_mm,mean_radius_mm,order,is_join\n");
    for edge in graphml::edges(venation) {
        let _ = writeln!(
            text,
            "{},{},{},{},{},{}",
            edge.source,
            edge.target,
            rounded(edge.length),
            rounded(edge.mean_radius),
            edge.order,
            edge.is_join,
        );
    }
    text
}

fn areoles(network: &Network) -> String {
    let mut text = String::from(
        "area_mm2,perimeter_mm,centroid_x_mm,centroid_y_mm,elongation,circularity,segments,\
         free_ends\n",
    );
    for areole in Areoles::of(network).list {
        let _ = writeln!(
            text,
            "{},{},{},{},{},{},{},{}",
            rounded(areole.area),
            rounded(areole.perimeter),
            rounded(areole.centroid.x),
            rounded(areole.centroid.y),
            rounded(areole.elongation),
            rounded(areole.circularity()),
            areole.segments,
            areole.free_ends,
        );
    }
    text
}
