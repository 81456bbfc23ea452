//! What made the surface of a part, and its normals.

use nalgebra::{Point3, Unit, Vector3};

use super::moves::{PathTool, Stage};
use crate::removal::{DexelPart, EndOrigin, StockSolid, SurfacePoint, ToolMove};

/// A part and what made its surface.
#[derive(Clone, Copy, Debug)]
pub struct MadePart<'a> {
    /// Its dexels.
    pub dexels: &'a DexelPart,
    /// The solid that it was at first.
    pub stock: StockSolid<'a>,
    /// What it was cut by; `None`: it is that solid.
    pub cut_by: Option<CutBy<'a>>,
}

/// What a part was cut by.
#[derive(Clone, Copy, Debug)]
pub struct CutBy<'a> {
    /// Moves.
    pub stages: &'a [Stage],
    /// Their tools.
    pub tools: &'a [PathTool],
    /// How far a turning axis may be off, m.
    pub turn_tolerance: f64,
}

impl<'a> MadePart<'a> {
    /// The normal at a point of its surface, out of the material; `None` where the tool has none.
    pub fn normals(&self) -> impl Fn(&SurfacePoint) -> Option<Unit<Vector3<f64>>> + Sync + 'a {
        let faces = Faces::of(self);
        move |point| faces.normal(point)
    }
}

/// The faces of a part.
#[derive(Clone, Debug)]
pub(super) struct Faces<'a> {
    stock: StockSolid<'a>,
    cut_by: Option<CutBy<'a>>,
    /// The move with each number, and its tool.
    by_number: Vec<Option<(usize, ToolMove)>>,
}

impl<'a> Faces<'a> {
    pub(super) fn of(part: &MadePart<'a>) -> Faces<'a> {
        let stages = part.cut_by.map_or(&[][..], |cut| cut.stages);
        let of_stage = |stage: &'a Stage| stage.moves.iter().map(move |at| (stage.tool, *at));
        let all = || stages.iter().flat_map(of_stage);
        let count = all().map(|(_, at)| at.index as usize + 1).max().unwrap_or(0);
        let mut by_number = vec![None; count];
        for (tool, at) in all() {
            by_number[at.index as usize] = Some((tool, at));
        }
        Faces {
            stock: part.stock,
            cut_by: part.cut_by,
            by_number,
        }
    }

    /// Whether an end is of the surface that is made: by a move if there are moves.
    pub(super) fn is_made(&self, origin: EndOrigin) -> bool {
        matches!(origin, EndOrigin::Move(_)) || self.cut_by.is_none()
    }

    /// The normal at an end, out of the material; `None` where the tool has none.
    pub(super) fn normal(&self, point: &SurfacePoint) -> Option<Unit<Vector3<f64>>> {
        match point.origin {
            EndOrigin::Stock(face) => self.stock.normal(face, &point.position),
            EndOrigin::Move(number) => self.of_move(number, &point.position),
        }
    }

    fn of_move(&self, number: u32, position: &Point3<f64>) -> Option<Unit<Vector3<f64>>> {
        let cut = self.cut_by?;
        let (tool, of) = self.by_number.get(number as usize)?.as_ref()?;
        of.surface_normal(&cut.tools[*tool].cutting, cut.turn_tolerance, position)
    }
}
