//! `beam.pvd`, `vtk/frame_*.vtu` and `vtk/obstacles_*.vtp`: the moving beam and what it may touch, for ParaView.
//!
//! Each frame is an unstructured grid in VTK's XML format, arrays inline in base64. The beam is a strip in the
//! plane of motion: at every station stand three points, the lower fibre, the axis and the upper fibre
//! (positions p − h/2 n, p, p + h/2 n with the normal n of the section), joined by two quadrilaterals for each
//! interval. Point data, the same across a section:
//!
//! | name | meaning |
//! |---|---|
//! | `displacement` | vector from the rigid beam that rotates with the root section to the axis \[m\], inertial frame |
//! | `axial`, `deflection` | the same along the tangent and the normal of the root section \[m\] |
//! | `rotation` | angle of the section against the root section [rad], about the third axis |
//! | `arc_length` | arc length from the root in the undeformed beam \[m\] |
//!
//! Format: <https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html>.

use std::io::{self, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::artifact::Artifact;
use super::shapes::Shape;
use flexion::linalg::Vec3;
use flexion::system::Frame;

/// Number of VTK's quadrilateral.
pub(super) const QUAD: u8 = 9;

/// Writes the shape at one time as a VTK unstructured grid (`.vtu`).
///
/// # Errors
/// Whatever `to` returns.
pub fn write_vtu(shape: &Shape<'_>, mut to: impl Write) -> io::Result<()> {
    let sections = shape.frames.len();
    let cells = 2 * sections.saturating_sub(1);
    let points: Vec<f64> =
        shape.frames.iter().flat_map(|frame| fibres(frame, shape.height)).flatten().collect();
    let moved = relative(shape);
    let each =
        |value: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..3 * sections).map(|i| value(i / 3)).collect() };
    let displacement: Vec<f64> = (0..3 * sections).flat_map(|i| moved[i / 3].displacement).collect();
    let (connectivity, offsets) = quads(sections);

    writeln!(to, r#"<?xml version="1.0"?>"#)?;
    writeln!(
        to,
        r#"<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">"#
    )?;
    writeln!(to, "<UnstructuredGrid>\n<FieldData>")?;
    reals(&mut to, "TimeValue", r#" NumberOfTuples="1""#, &[shape.time])?;
    writeln!(to, "</FieldData>")?;
    writeln!(to, r#"<Piece NumberOfPoints="{}" NumberOfCells="{cells}">"#, 3 * sections)?;
    writeln!(to, r#"<PointData Vectors="displacement" Scalars="deflection">"#)?;
    let vector = r#" NumberOfComponents="3""#;
    reals(&mut to, "displacement", vector, &displacement)?;
    reals(&mut to, "deflection", "", &each(&|i| moved[i].deflection))?;
    reals(&mut to, "axial", "", &each(&|i| moved[i].axial))?;
    reals(&mut to, "rotation", "", &each(&|i| moved[i].rotation))?;
    reals(&mut to, "arc_length", "", &each(&|i| shape.stations.get(i).copied().unwrap_or(f64::NAN)))?;
    writeln!(to, "</PointData>\n<Points>")?;
    reals(&mut to, "Points", vector, &points)?;
    writeln!(to, "</Points>\n<Cells>")?;
    array(&mut to, "Int32", "connectivity", "", connectivity.iter().flat_map(|i| i.to_le_bytes()))?;
    array(&mut to, "Int32", "offsets", "", offsets.iter().flat_map(|i| i.to_le_bytes()))?;
    array(&mut to, "UInt8", "types", "", std::iter::repeat_n(QUAD, cells))?;
    writeln!(to, "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")
}

/// Writes lines, such as the outlines of obstacles \[m\], as VTK polygonal data (`.vtp`).
///
/// # Errors
/// Whatever `to` returns.
pub fn write_vtp(lines: &[Vec<Vec3>], mut to: impl Write) -> io::Result<()> {
    let points: Vec<f64> = lines.iter().flatten().flatten().copied().collect();
    let connectivity = (0..points.len() as i32 / 3).flat_map(i32::to_le_bytes);
    let mut end = 0;
    let offsets: Vec<i32> = lines
        .iter()
        .map(|line| {
            end += line.len() as i32;
            end
        })
        .collect();
    writeln!(to, r#"<?xml version="1.0"?>"#)?;
    writeln!(
        to,
        r#"<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">"#
    )?;
    let (points_count, lines_count) = (points.len() / 3, lines.len());
    writeln!(to, "<PolyData>")?;
    writeln!(to, r#"<Piece NumberOfPoints="{points_count}" NumberOfLines="{lines_count}">"#)?;
    writeln!(to, "<Points>")?;
    reals(&mut to, "Points", r#" NumberOfComponents="3""#, &points)?;
    writeln!(to, "</Points>\n<Lines>")?;
    array(&mut to, "Int32", "connectivity", "", connectivity)?;
    array(&mut to, "Int32", "offsets", "", offsets.iter().flat_map(|i| i.to_le_bytes()))?;
    writeln!(to, "</Lines>\n</Piece>\n</PolyData>\n</VTKFile>")
}

/// Writes the collection (`.pvd`) that gives each frame its time \[s\], with `obstacles` in a second part.
///
/// # Errors
/// Whatever `to` returns.
pub fn write_pvd(times: &[f64], obstacles: bool, mut to: impl Write) -> io::Result<()> {
    writeln!(to, r#"<?xml version="1.0"?>"#)?;
    writeln!(to, r#"<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">"#)?;
    writeln!(to, "<Collection>")?;
    for (number, time) in (0..).zip(times) {
        let file = Artifact::Shape(number).file_name();
        writeln!(to, r#"<DataSet timestep="{time:?}" part="0" file="{file}"/>"#)?;
        if obstacles {
            let file = Artifact::Obstacles(number).file_name();
            writeln!(to, r#"<DataSet timestep="{time:?}" part="1" file="{file}"/>"#)?;
        }
    }
    writeln!(to, "</Collection>\n</VTKFile>")
}

/// How a section has moved against the root.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Relative {
    pub(super) displacement: Vec3,
    pub(super) axial: f64,
    pub(super) deflection: f64,
    pub(super) rotation: f64,
}

pub(super) fn relative(shape: &Shape<'_>) -> Vec<Relative> {
    let Some(root) = shape.frames.first() else { return Vec::new() };
    let (tangent, normal) = (root.rotation.column(0), root.rotation.column(1));
    let first = shape.stations.first().copied().unwrap_or(0.0);
    let mut turned = 0.0;
    let one = |(frame, x): (&Frame, &f64)| {
        let displacement = frame.position - (root.position + (x - first) * tangent);
        let section = frame.rotation.column(0);
        let angle = libm::atan2(section.dot(normal), section.dot(tangent));
        // Followed from the root, so that it may pass π.
        let whole = std::f64::consts::TAU;
        turned = angle + whole * ((turned - angle) / whole).round();
        let (axial, deflection) = (displacement.dot(tangent), displacement.dot(normal));
        Relative { displacement, axial, deflection, rotation: turned }
    };
    shape.frames.iter().zip(shape.stations).map(one).collect()
}

/// Lower fibre, axis and upper fibre of a section.
pub(super) fn fibres(frame: &Frame, height: f64) -> [Vec3; 3] {
    let at = |s: f64| frame.position + s * height * frame.rotation.column(1);
    [at(-0.5), frame.position, at(0.5)]
}

/// Corners of the quadrilaterals, counterclockwise, and where each one ends in the list.
pub(super) fn quads(sections: usize) -> (Vec<i32>, Vec<i32>) {
    let mut corners = Vec::new();
    for i in (0..sections.saturating_sub(1) as i32).map(|i| 3 * i) {
        corners.extend([i, i + 3, i + 4, i + 1]);
        corners.extend([i + 1, i + 4, i + 5, i + 2]);
    }
    let offsets = (1..=corners.len() as i32 / 4).map(|cell| 4 * cell).collect();
    (corners, offsets)
}

pub(super) fn reals(to: &mut impl Write, name: &str, attributes: &str, values: &[f64]) -> io::Result<()> {
    array(to, "Float64", name, attributes, values.iter().flat_map(|y| y.to_le_bytes()))
}

/// A data array: the number of bytes as UInt64, then the bytes, together in base64.
pub(super) fn array(
    to: &mut impl Write,
    kind: &str,
    name: &str,
    attributes: &str,
    bytes: impl Iterator<Item = u8>,
) -> io::Result<()> {
    let mut block = vec![0; 8];
    block.extend(bytes);
    let length = (block.len() - 8) as u64;
    block[..8].copy_from_slice(&length.to_le_bytes());
    let text = STANDARD.encode(block);
    writeln!(to, r#"<DataArray type="{kind}" Name="{name}"{attributes} format="binary">{text}</DataArray>"#)
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexion::linalg::Mat3;

    /// A quarter circle of length L in a frame turned by `angle` whose root stands at `radius` from the axis.
    fn quarter_circle(angle: f64, radius: f64, length: f64) -> (Vec<f64>, Vec<Frame>) {
        let bend = std::f64::consts::FRAC_PI_2;
        let stations: Vec<f64> = (0..=10).map(|i| length * f64::from(i) / 10.0).collect();
        let frame = |x: &f64| {
            let (along, turn) = (length / bend, bend * x / length);
            let (u, w) = (radius + along * turn.sin(), along * (1.0 - turn.cos()));
            let (s, c) = angle.sin_cos();
            let (ss, cs) = (angle + turn).sin_cos();
            Frame {
                position: Vec3([u * c - w * s, u * s + w * c, 0.0]),
                rotation: Mat3([[cs, -ss, 0.0], [ss, cs, 0.0], [0.0, 0.0, 1.0]]),
            }
        };
        let frames = stations.iter().map(frame).collect();
        (stations, frames)
    }

    fn text(angle: f64) -> String {
        let (stations, frames) = quarter_circle(angle, 0.5, 2.0);
        let shape = Shape { time: 0.1, stations: &stations, frames: &frames, height: 0.1 };
        let mut out = Vec::new();
        write_vtu(&shape, &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    /// The bytes of an array after its header, which must agree with them.
    fn bytes(document: &roxmltree::Document<'_>, name: &str) -> Vec<u8> {
        let node = document.descendants().find(|n| n.attribute("Name") == Some(name)).unwrap();
        assert_eq!(node.attribute("format"), Some("binary"));
        let block = STANDARD.decode(node.text().unwrap()).unwrap();
        assert_eq!(u64::from_le_bytes(block[..8].try_into().unwrap()) as usize, block.len() - 8, "{name}");
        block[8..].to_vec()
    }

    fn numbers(document: &roxmltree::Document<'_>, name: &str) -> Vec<f64> {
        bytes(document, name).chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect()
    }

    fn integers(document: &roxmltree::Document<'_>, name: &str) -> Vec<usize> {
        bytes(document, name).chunks(4).map(|b| i32::from_le_bytes(b.try_into().unwrap()) as usize).collect()
    }

    #[test]
    fn a_quarter_circle_has_the_displacements_of_its_closed_form() {
        for angle in [0.0, 2.0, -7.0] {
            let text = text(angle);
            let document = roxmltree::Document::parse(&text).unwrap();
            let tip = 4.0 / std::f64::consts::PI; // radius of the circle
            let last = |name: &str| numbers(&document, name)[10 * 3 + 1];
            assert!((last("deflection") - tip).abs() < 1e-14);
            assert!((last("axial") - (tip - 2.0)).abs() < 1e-14);
            assert!((last("rotation") - std::f64::consts::FRAC_PI_2).abs() < 1e-14);
            assert_eq!(last("arc_length"), 2.0);
            assert_eq!(numbers(&document, "TimeValue"), [0.1]);
            // The root has not moved.
            assert!(numbers(&document, "displacement")[..9].iter().all(|d| *d == 0.0));
        }
    }

    #[test]
    fn the_cells_cover_the_strip_without_gap_or_overlap() {
        let text = text(0.3);
        let document = roxmltree::Document::parse(&text).unwrap();
        let piece = document.descendants().find(|n| n.has_tag_name("Piece")).unwrap();
        assert_eq!(
            (piece.attribute("NumberOfPoints"), piece.attribute("NumberOfCells")),
            (Some("33"), Some("20"))
        );
        let points = numbers(&document, "Points");
        assert_eq!(points.len(), 99);
        let (corners, offsets) = (integers(&document, "connectivity"), integers(&document, "offsets"));
        assert_eq!(offsets, (1..=20).map(|i| 4 * i).collect::<Vec<_>>());
        assert_eq!(bytes(&document, "types"), [QUAD; 20]);
        let area: f64 = corners
            .chunks(4)
            .map(|quad| {
                let at = |i: usize| (points[3 * quad[i % 4]], points[3 * quad[i % 4] + 1]);
                let area: f64 =
                    (0..4).map(|i| at(i).0 * at(i + 1).1 - at(i + 1).0 * at(i).1).sum::<f64>() / 2.0;
                assert!(area > 0.0, "counterclockwise");
                area
            })
            .sum();
        // Polygons inscribed into rings: L h for small intervals, by sin φ/φ of the opening φ = π/20 of each.
        let opening = std::f64::consts::PI / 20.0;
        assert!((area - 0.2 * opening.sin() / opening).abs() < 1e-14, "{area}");
    }

    #[test]
    fn the_collection_names_every_frame_with_its_time() {
        let mut out = Vec::new();
        write_pvd(&[0.0, 0.1, 1.0 / 3.0], false, &mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let sets: Vec<(f64, &str)> = document
            .descendants()
            .filter(|n| n.has_tag_name("DataSet"))
            .map(|n| (n.attribute("timestep").unwrap().parse().unwrap(), n.attribute("file").unwrap()))
            .collect();
        let names = ["vtk/frame_00000.vtu", "vtk/frame_00001.vtu", "vtk/frame_00002.vtu"];
        assert_eq!(sets, [(0.0, names[0]), (0.1, names[1]), (1.0 / 3.0, names[2])]);
    }

    #[test]
    fn a_shape_without_sections_is_an_empty_grid() {
        let mut out = Vec::new();
        let shape = Shape { time: 0.0, stations: &[], frames: &[], height: 1.0 };
        write_vtu(&shape, &mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert!(roxmltree::Document::parse(&text).is_ok() && text.contains(r#"NumberOfCells="0""#));
    }
}
