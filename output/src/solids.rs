//! `vtk/frame_*.vtu` of a system in space: its bodies as boxes and its beams as swept rectangles, for ParaView.
//!
//! Every section is a rectangle of four points; quadrilaterals join two sections, and one closes each end. Point data: `part`, the
//! number of the part in the order of the case, bodies first; `station`, the number of the section in its part.

use super::scene::Scene;
use super::vtk::{QUAD, array, reals, write_pvd};
use super::{Artifact, Directory, OutputError, write_vtp};
use flexion::multibody::rotation::{apply, plus};
use std::io::{self, Write};

/// Corners of a section, counterclockwise seen from its front.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Writes the parts at the time of this number as a VTK unstructured grid (`.vtu`).
///
/// # Errors
/// Whatever `to` returns.
pub fn write_solids(scene: &Scene, time: usize, mut to: impl Write) -> io::Result<()> {
    let (mut points, mut part, mut station) = (Vec::new(), Vec::new(), Vec::new());
    let mut corners: Vec<i32> = Vec::new();
    for (number, solid) in scene.parts().iter().enumerate() {
        let first = points.len() as i32 / 3;
        let (sections, half) = solid.sections(time);
        for (k, section) in sections.iter().enumerate() {
            for [y, z] in CORNERS {
                let arm = apply(&section.rotation, [0.0, y * half[0], z * half[1]]);
                points.extend(plus(section.position, 1.0, arm));
                part.push(number as f64);
                station.push(k as f64);
            }
        }
        let at = |section: usize, corner: usize| first + 4 * section as i32 + (corner % 4) as i32;
        for k in 1..sections.len() {
            corners.extend((0..4).flat_map(|i| [at(k - 1, i), at(k - 1, i + 1), at(k, i + 1), at(k, i)]));
        }
        if let Some(last) = sections.len().checked_sub(1) {
            corners.extend([at(0, 3), at(0, 2), at(0, 1), at(0, 0)]);
            corners.extend([at(last, 0), at(last, 1), at(last, 2), at(last, 3)]);
        }
    }
    let cells = corners.len() / 4;
    writeln!(to, r#"<?xml version="1.0"?>"#)?;
    writeln!(
        to,
        r#"<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">"#
    )?;
    writeln!(to, "<UnstructuredGrid>\n<FieldData>")?;
    let now = scene.times().get(time).copied().unwrap_or(f64::NAN);
    reals(&mut to, "TimeValue", r#" NumberOfTuples="1""#, &[now])?;
    writeln!(to, "</FieldData>")?;
    writeln!(to, r#"<Piece NumberOfPoints="{}" NumberOfCells="{cells}">"#, part.len())?;
    writeln!(to, r#"<PointData Scalars="part">"#)?;
    reals(&mut to, "part", "", &part)?;
    reals(&mut to, "station", "", &station)?;
    writeln!(to, "</PointData>\n<Points>")?;
    reals(&mut to, "Points", r#" NumberOfComponents="3""#, &points)?;
    writeln!(to, "</Points>\n<Cells>")?;
    array(&mut to, "Int32", "connectivity", "", corners.iter().flat_map(|i| i.to_le_bytes()))?;
    let ends = (1..=cells as i32).map(|cell| 4 * cell);
    array(&mut to, "Int32", "offsets", "", ends.flat_map(i32::to_le_bytes))?;
    array(&mut to, "UInt8", "types", "", std::iter::repeat_n(QUAD, cells))?;
    writeln!(to, "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")
}

/// Writes the parts at every time of a scene, and the `series` of the times.
///
/// # Errors
/// [`OutputError`] for whatever goes wrong on disk.
pub fn write_film(directory: &Directory, scene: &Scene, series: Artifact) -> Result<(), OutputError> {
    for (time, number) in (0..scene.times().len()).zip(0..) {
        directory.write(Artifact::Shape(number), |f| write_solids(scene, time, f))?;
        if scene.has_obstacles() {
            directory.write(Artifact::Obstacles(number), |f| write_vtp(&scene.outlines(time), f))?;
        }
    }
    directory.write(series, |f| write_pvd(scene.times(), scene.has_obstacles(), f))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Part;
    use base64::Engine;
    use flexion::multibody::rotation::{exponential, matrix};
    use flexion::multibody::{Body, Model, Multibody};
    use flexion::system::{Dynamics, System};

    fn numbers(document: &roxmltree::Document<'_>, name: &str) -> Vec<f64> {
        let node = document.descendants().find(|n| n.attribute("Name") == Some(name)).unwrap();
        let block = base64::engine::general_purpose::STANDARD.decode(node.text().unwrap()).unwrap();
        block[8..].chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect()
    }

    /// Divergence theorem: ∮ x·n dA = 3 V of a closed surface, whatever its position and its axes.
    #[test]
    fn the_box_of_a_body_is_closed_and_has_its_volume() {
        let mut model = Model::new();
        let mut body = Body::new("box", 2.0, [0.4, 0.5, 0.6]).at([1.0, -2.0, 0.5]);
        body.frame.rotation = matrix(exponential([0.4, -1.1, 0.7]));
        model.body(body);
        let mut system = Multibody::new(model).unwrap();
        let state = Dynamics::initial(&system);
        let edges = [0.4, 0.2, 0.1];
        let mut scene = Scene::new(vec![Part::rigid(("box", 0), [0.1, 0.0, 0.0], edges)], Vec::new(), 1);
        scene.finish(&mut system as &mut dyn System, &state);
        let mut out = Vec::new();
        write_solids(&scene, 0, &mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let points = numbers(&document, "Points");
        let node = document.descendants().find(|n| n.attribute("Name") == Some("connectivity")).unwrap();
        let block = base64::engine::general_purpose::STANDARD.decode(node.text().unwrap()).unwrap();
        let corners: Vec<usize> =
            block[8..].chunks(4).map(|b| i32::from_le_bytes(b.try_into().unwrap()) as usize).collect();
        assert_eq!(corners.len(), 6 * 4);
        let at = |i: usize| [points[3 * i], points[3 * i + 1], points[3 * i + 2]];
        let minus = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let volume: f64 = corners
            .chunks(4)
            .map(|quad| {
                let [a, b, c, d] = [at(quad[0]), at(quad[1]), at(quad[2]), at(quad[3])];
                let (u, v) = (minus(c, a), minus(d, b));
                let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
                (0..3).map(|i| 0.5 * n[i] * 0.25 * (a[i] + b[i] + c[i] + d[i])).sum::<f64>() / 3.0
            })
            .sum();
        assert!((volume - 0.4 * 0.2 * 0.1).abs() < 1e-6, "{volume}");
    }
}
