//! `vtk/frame_*.vtu` of a system in space: its bodies as boxes and its beams as swept sections, for ParaView.
//!
//! Every section is the polygon of its contour, hollow ones have two; quadrilaterals join two sections, and polygons close the ends:
//! the surface is closed, with its normals outwards. Point data: `part`, the number of the part in the order of the case, bodies
//! first; `station`, the number of the section in its part.

use super::contour::Contour;
use super::scene::{Part, Scene};
use super::vtk::{array, reals, write_pvd};
use super::{Artifact, Directory, OutputError, write_vtp};
use flexion::linalg::Vec3;
use std::io::{self, Write};

/// Number of VTK's polygon.
const POLYGON: u8 = 7;

/// Points with their data, and polygons.
#[derive(Default)]
struct Surface {
    points: Vec<f64>,
    part: Vec<f64>,
    station: Vec<f64>,
    corners: Vec<i32>,
    /// Where each polygon ends among the corners.
    ends: Vec<i32>,
}

impl Surface {
    fn polygon(&mut self, corners: impl IntoIterator<Item = i32>) {
        self.corners.extend(corners);
        self.ends.push(self.corners.len() as i32);
    }

    /// Adds the surface of part `number` at a time.
    fn add(&mut self, number: usize, part: &Part, time: usize) {
        let Some(Contour { outer, inner }) = part.contours().first() else { return };
        let (outer, inner) = (outer.len() as i32, inner.len() as i32);
        let first = self.part.len() as i32;
        let sections = part.sections(time);
        for (k, (section, contour)) in sections.iter().zip(part.contours()).enumerate() {
            for [y, z] in contour.outer.iter().chain(&contour.inner) {
                self.points.extend((section.position + section.rotation * Vec3([0.0, *y, *z])).0);
                self.part.push(number as f64);
                self.station.push(k as f64);
            }
        }
        let last = sections.len() as i32 - 1;
        let out = |k: i32, i: i32| first + k * (outer + inner) + i % outer;
        let into = |k: i32, i: i32| first + k * (outer + inner) + outer + i % inner;
        for k in 1..=last {
            (0..outer)
                .for_each(|i| self.polygon([out(k - 1, i), out(k - 1, i + 1), out(k, i + 1), out(k, i)]));
            (0..inner)
                .for_each(|i| self.polygon([into(k, i), into(k, i + 1), into(k - 1, i + 1), into(k - 1, i)]));
        }
        if inner == 0 {
            self.polygon((0..outer).rev().map(|i| out(0, i)));
            self.polygon((0..outer).map(|i| out(last, i)));
        }
        // The corners of an inner polygon are those of the outer one, further inwards.
        for i in 0..inner {
            self.polygon([out(0, i), into(0, i), into(0, i + 1), out(0, i + 1)]);
            self.polygon([out(last, i), out(last, i + 1), into(last, i + 1), into(last, i)]);
        }
    }
}

/// Writes the parts at the time of this number as a VTK unstructured grid (`.vtu`).
///
/// # Errors
/// Whatever `to` returns.
pub fn write_solids(scene: &Scene, time: usize, mut to: impl Write) -> io::Result<()> {
    let mut surface = Surface::default();
    scene.parts().iter().enumerate().for_each(|(number, part)| surface.add(number, part, time));
    let Surface { points, part, station, corners, ends } = surface;
    let cells = ends.len();
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
    array(&mut to, "Int32", "offsets", "", ends.into_iter().flat_map(i32::to_le_bytes))?;
    array(&mut to, "UInt8", "types", "", std::iter::repeat_n(POLYGON, cells))?;
    writeln!(to, "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")
}

/// Writes the parts at every time of a scene, and the `series` of the times.
///
/// # Errors
/// [`OutputError`] for whatever goes wrong on disk.
pub fn write_film(directory: &Directory, scene: &Scene, series: Artifact) -> Result<(), OutputError> {
    for (time, number) in (0..scene.times().len()).zip(0..) {
        directory.write(Artifact::Shape(number), |f| write_solids(scene, time, f))?;
        if scene.has_lines() {
            let lines: Vec<_> =
                scene.outlines(time).into_iter().chain(scene.lines_of_springs(time)).collect();
            directory.write(Artifact::Obstacles(number), |f| write_vtp(&lines, f))?;
        }
    }
    directory.write(series, |f| write_pvd(scene.times(), scene.has_lines(), f))
}

#[cfg(test)]
mod tests {
    use super::*;
    use base64::Engine;
    use flexion::multibody::rotation::about;
    use flexion::multibody::{Body, Model, Multibody};
    use flexion::section::Shape;
    use flexion::system::{Dynamics, Events, Frame, Observed, Size, State, Steady, System, Weights};
    use std::collections::HashMap;

    /// A beam that is bent to an arc about the third axis and twisted, by the angles of its state.
    struct Bent;

    impl Dynamics for Bent {
        fn size(&self) -> Size {
            Size::default()
        }
        fn scales(&self) -> &[f64] {
            &[]
        }
        fn residual(&mut self, _: &State, _: &mut [f64]) {}
        fn tangent(&mut self, _: &State, _: Weights<'_>, _: &mut flexion::linalg::Matrix) {}
    }
    impl Events for Bent {}
    impl Steady for Bent {}
    impl Observed for Bent {
        fn frames(&mut self, _: usize, s: &State, stations: &[f64], out: &mut [Frame]) {
            let (bend, twist) = (s.q[0].max(1e-9), s.q[1]);
            let turned = about([0.4, -1.1, 0.7]);
            for (x, frame) in stations.iter().zip(out) {
                let (sin, cos) = (bend * x).sin_cos();
                let section = about([0.0, 0.0, bend * x]) * about([twist * x, 0.0, 0.0]);
                *frame = Frame {
                    position: Vec3([3.0, -2.0, 1.0]) + turned * Vec3([sin / bend, (1.0 - cos) / bend, 0.0]),
                    rotation: turned * section,
                };
            }
        }
    }

    fn bytes(document: &roxmltree::Document<'_>, name: &str) -> Vec<u8> {
        let node = document.descendants().find(|n| n.attribute("Name") == Some(name)).unwrap();
        base64::engine::general_purpose::STANDARD.decode(node.text().unwrap()).unwrap()[8..].to_vec()
    }

    /// The volume that the surface of a scene encloses at its first time, if it is closed: every edge belongs to two polygons,
    /// which pass it in opposite directions.
    fn volume(scene: &Scene) -> f64 {
        let mut out = Vec::new();
        write_solids(scene, 0, &mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let points = bytes(&document, "Points");
        let points: Vec<f64> = points.chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
        let integers = |name: &str| -> Vec<usize> {
            let list = bytes(&document, name);
            list.chunks(4).map(|b| i32::from_le_bytes(b.try_into().unwrap()) as usize).collect()
        };
        let (corners, ends) = (integers("connectivity"), integers("offsets"));
        let starts = std::iter::once(0).chain(ends.iter().copied());
        let polygons: Vec<&[usize]> = starts.zip(&ends).map(|(from, to)| &corners[from..*to]).collect();
        assert_eq!(bytes(&document, "types"), vec![POLYGON; polygons.len()]);
        let mut edges: HashMap<(usize, usize), usize> = HashMap::new();
        for polygon in &polygons {
            let next = polygon.iter().cycle().skip(1);
            polygon.iter().zip(next).for_each(|(a, b)| *edges.entry((*a, *b)).or_default() += 1);
        }
        assert!(edges.iter().all(|((a, b), count)| *count == 1 && edges.get(&(*b, *a)) == Some(&1)));
        // Divergence theorem, ∮ x·n dA = 3V, over triangles about the mean of the corners of each polygon.
        let at = |i: usize| -> Vec3 { Vec3::at(&points, 3 * i) };
        let mut sum = 0.0;
        for polygon in polygons {
            let share = 1.0 / polygon.len() as f64;
            let middle = polygon.iter().fold(Vec3::ZERO, |sum, i| sum + share * at(*i));
            for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
                let normal = at(*a).cross(at(*b));
                sum += middle.dot(normal) / 6.0;
            }
        }
        sum
    }

    /// The volume of a beam of 2 m with the contour of every station, bent and twisted by the angles per length.
    fn swept(contour: impl Fn(f64) -> Contour, angles: [f64; 2]) -> f64 {
        let mut scene = Scene::new(vec![Part::beam(("arm", 0), (2.0, 1), contour, None, &[])], Vec::new(), 1);
        scene.take(0.0, &mut Bent, &State { q: angles.to_vec(), ..State::default() });
        volume(&scene)
    }

    /// Poses are stored in single precision.
    fn assert_near(found: f64, exact: f64) {
        assert!((found / exact - 1.0).abs() < 2e-6, "{found} for {exact}");
    }

    #[test]
    fn the_box_of_a_body_is_closed_and_has_its_volume() {
        let mut model = Model::new();
        let mut body = Body::new("box", 2.0, [0.4, 0.5, 0.6]).at([1.0, -2.0, 0.5]);
        body.frame.rotation = about([0.4, -1.1, 0.7]);
        model.body(body);
        let mut system = Multibody::new(model).unwrap();
        let state = Dynamics::initial(&system);
        let edges = [0.4, 0.2, 0.1];
        let mut scene =
            Scene::new(vec![Part::rigid(("box", 0), Vec3([0.1, 0.0, 0.0]), edges)], Vec::new(), 1);
        scene.finish(&mut system as &mut dyn System, &state);
        assert_near(volume(&scene), 0.4 * 0.2 * 0.1);
    }

    #[test]
    fn a_straight_beam_encloses_its_area_times_its_length() {
        let shapes = [
            Shape::Rectangle { width: 0.3, height: 0.2 },
            Shape::Circle { radius: 0.1 },
            Shape::Ellipse { semi_width: 0.15, semi_height: 0.1 },
            Shape::Tube { outer_radius: 0.1, inner_radius: 0.07 },
        ];
        for shape in shapes {
            assert_near(swept(|_| Contour::of(&shape), [0.0; 2]), 2.0 * shape.area());
        }
        // An angle, which is not convex, given clockwise.
        let angle = vec![[0.0, 0.0], [0.0, 0.3], [0.1, 0.3], [0.1, 0.1], [0.4, 0.1], [0.4, 0.0]];
        let angle = Contour::through(angle).unwrap();
        assert_near(swept(|_| angle.clone(), [0.0; 2]), 2.0 * (0.03 + 0.03));
    }

    /// Linear dimensions from root to tip: the volume of a truncated cone, L/3 π (R² + Rr + r²), bore taken off.
    #[test]
    fn a_tapered_tube_encloses_the_volume_of_its_wall() {
        let tube = |outer_radius, inner_radius| Shape::Tube { outer_radius, inner_radius };
        let between = |s: f64| tube(0.2, 0.15).between(tube(0.1, 0.02), 0.5 * s).unwrap();
        let cone = |a: f64, b: f64| 2.0 / 3.0 * std::f64::consts::PI * (a * a + a * b + b * b);
        assert_near(swept(|s| Contour::of(&between(s)), [0.0; 2]), cone(0.2, 0.1) - cone(0.15, 0.02));
    }

    /// Pappus: a section whose centroid stays on the axis sweeps A L, however the beam is bent and twisted. Chords in place of
    /// arcs and flat pieces in place of twisted ones leave an error that falls with the square of the interval.
    #[test]
    fn a_bent_and_twisted_beam_encloses_its_area_times_its_length() {
        let (tube, bar) = (
            Shape::Tube { outer_radius: 0.1, inner_radius: 0.07 },
            Shape::Rectangle { width: 0.2, height: 0.1 },
        );
        for (shape, angles) in [(tube, [0.7, 0.0]), (bar, [0.0, 0.7]), (bar, [0.7, 0.7])] {
            let found = swept(|_| Contour::of(&shape), angles) / (2.0 * shape.area());
            assert!((found - 1.0).abs() < 1.2e-3, "{shape:?} {angles:?}: {found}");
        }
    }
}
