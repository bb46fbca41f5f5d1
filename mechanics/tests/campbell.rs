//! Campbell diagrams: modes joined by their shapes.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

use flexion::analysis::campbell::{
    Campbell, HubState, Instability, NoCampbell, Plan, Speeds, assemble, campbell,
};
use flexion::analysis::modes::modes;
use flexion::analysis::rotation::rotate;
use flexion::basis::{Field, Hermite, Lagrange};
use flexion::hub_beam::{Fields, Foreshortening, Hub, HubBeam, LinearCoupling};
use flexion::profile::{Constant, Motion};
use flexion::section::{Resultants, Uniform};
use flexion::system::{State, System};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// L = ρA = EI = 1, EA = slenderness².
fn beam(slenderness: f64, foreshortening: Foreshortening) -> Box<dyn System> {
    let resultants = Resultants {
        mass: 1.0,
        axial_stiffness: slenderness * slenderness,
        bending_stiffness: 1.0,
        ..Resultants::default()
    };
    let section = Uniform::from_resultants(resultants).unwrap();
    let profile = Arc::new(Constant::new(0.0).unwrap());
    let hub = Hub::prescribed(0.0, 0.0, Motion::Speed { profile, initial_angle: 0.0 });
    let axial = Box::new(Lagrange::new(1.0, 20, 1).unwrap());
    let transverse = Box::new(Hermite::new(1.0, 20, Field::Transverse).unwrap());
    let fields = Fields::new(1.0, axial, transverse, &[]);
    let coupling = LinearCoupling::new(fields, &section, &hub, foreshortening);
    Box::new(HubBeam::new(hub, coupling, &[]))
}

fn plan(to: f64, number: u32, count: usize) -> Plan {
    Plan {
        speeds: (0..number).map(|i| to * f64::from(i) / f64::from(number - 1)).collect(),
        count,
        stations: vec![0.0, 0.25, 0.5, 0.75, 1.0],
        hub: HubState::Held,
        revolutions: 4,
    }
}

fn diagram(slenderness: f64, plan: &Plan) -> Campbell {
    campbell(beam(slenderness, Foreshortening::First), plan, |_| true).unwrap()
}

#[test]
fn blocks_computed_apart_and_in_any_order_make_the_same_diagram() {
    let plan = plan(20.0, 60, 4);
    let alone = diagram(70.0, &plan);
    let speeds = || Speeds::new(beam(70.0, Foreshortening::First), &plan, &|| true).unwrap();
    let (mut one, mut other) = (speeds(), speeds());
    assert_eq!(Speeds::blocks(&plan), 3);
    let last = one.block(2, || true);
    let blocks = vec![one.block(0, || true), other.block(1, || true), last];
    assert_eq!(alone, assemble(&mut other, blocks, || true).unwrap());
    assert_eq!(alone.branches.len(), 4);
    assert!(alone.branches.iter().all(|b| b.points.len() == alone.speeds.len()));
    assert!(one.block(1, || false).ends());
}

/// What was found before a stop is kept, and the diagram says that it was stopped; a single speed makes none.
#[test]
fn a_diagram_that_is_stopped_keeps_the_speeds_that_are_done() {
    let plan = plan(20.0, 60, 4);
    let whole = diagram(70.0, &plan);
    let stopped = campbell(beam(70.0, Foreshortening::First), &plan, |done| done < 37).unwrap();
    let last = stopped.speeds.last().copied().unwrap();
    assert_eq!(last, plan.speeds[36]);
    assert!(stopped.speeds.iter().eq(whole.speeds.iter().filter(|speed| **speed <= last)));
    assert!(
        matches!(&stopped.instabilities[..], [Instability::Lost { reason, .. }] if reason.contains("stopped"))
    );
}

#[test]
fn a_stop_while_speeds_are_inserted_ends_the_diagram_there() {
    // The first axial mode is met by bending modes.
    let plan = plan(40.0, 3, 4);
    let whole = diagram(70.0, &plan);
    assert!(whole.speeds.len() > plan.speeds.len());
    // All speeds that were asked for are done; it is asked again where one is inserted.
    let all = AtomicUsize::new(0);
    let stopped = campbell(beam(70.0, Foreshortening::First), &plan, |done| {
        done < plan.speeds.len() || all.fetch_add(1, Ordering::Relaxed) == 0
    })
    .unwrap();
    assert!(all.into_inner() > 1);
    assert!(plan.speeds.starts_with(&stopped.speeds) && stopped.speeds.len() < plan.speeds.len());
    assert!(
        matches!(&stopped.instabilities[..], [.., Instability::Lost { reason, .. }] if reason.contains("stopped"))
    );
}

#[test]
fn a_branch_keeps_its_shape_where_frequencies_come_close() {
    // The first axial mode, at π/2 · slenderness = 110 at rest, is met by the bending modes from below: the curves veer.
    let diagram = diagram(70.0, &plan(40.0, 21, 4));
    for branch in &diagram.branches {
        for pair in branch.points.windows(2) {
            assert!(pair[1].assurance > 0.6, "assurance {} at {}", pair[1].assurance, pair[1].speed);
            let jump = pair[1].mode.frequency() / pair[0].mode.frequency() - 1.0;
            assert!(jump.abs() < 0.25, "a jump by {jump} at {}", pair[1].speed);
        }
    }
}

/// Modes found anew at a speed, from rest.
fn anew(slenderness: f64, speed: f64, count: usize) -> Vec<f64> {
    let mut system = beam(slenderness, Foreshortening::First);
    let mut state = State::zeros(system.size(), 0.0);
    rotate(system.as_mut(), &mut state, 0.0, speed, &mut || true).unwrap();
    let modes = modes(system.as_mut(), &state, count, &[]).unwrap();
    assert_eq!(modes.counted, Some(count));
    modes.modes.iter().map(|m| m.frequency()).collect()
}

#[test]
fn at_a_crossing_a_mode_has_a_whole_number_of_vibrations_a_revolution() {
    let diagram = diagram(1000.0, &plan(20.0, 41, 2));
    let of = |branch, k| {
        diagram.crossings.iter().filter(|c| c.branch == branch && c.revolutions == k).collect::<Vec<_>>()
    };
    assert_eq!(of(1, 4).len(), 1, "{:?}", diagram.crossings);
    for c in &diagram.crossings {
        let excitation = f64::from(c.revolutions) * c.speed;
        let off = |frequency: f64| (frequency / excitation - 1.0).abs();
        let nearest = anew(1000.0, c.speed, 4).into_iter().map(off).fold(f64::INFINITY, f64::min);
        // The accuracy asked for, and the rounding of K at 20 elements.
        assert!(nearest < 3e-9, "off by {nearest:e} at {}", c.speed);
    }
}

/// A beam whose axial modes lie among the bending modes, at speeds at which they cross: Krylov spaces that begin with the
/// modes of the last speed against those that begin with a random vector.
#[test]
fn the_modes_of_a_diagram_are_those_of_each_speed_alone_and_none_is_missing() {
    for slenderness in [20.0, 70.0, 1000.0] {
        let diagram = diagram(slenderness, &plan(12.0, 31, 6));
        for speed in diagram.speeds.iter().step_by(6) {
            let mut joined: Vec<f64> = Vec::new();
            for branch in &diagram.branches {
                let point = branch.points.iter().find(|p| p.speed == *speed).unwrap();
                assert!(point.mode.residual < 1e-7);
                joined.push(point.mode.frequency());
            }
            joined.sort_by(f64::total_cmp);
            // No crossing leads out of the first six at these speeds.
            for (a, b) in joined.iter().zip(anew(slenderness, *speed, 6)) {
                assert!((a / b - 1.0).abs() < 1e-8, "{a} and {b} at {speed}, slenderness {slenderness}");
            }
        }
    }
}

#[test]
fn a_diagram_goes_on_beyond_buckling_and_says_where_it_begins() {
    let plan = plan(10.0, 21, 2);
    let diagram = campbell(beam(1000.0, Foreshortening::None), &plan, |_| true).unwrap();
    let [Instability::Divergence { speed, until: None }] = diagram.instabilities[..] else {
        panic!("{:?}", diagram.instabilities);
    };
    // K − Ω²M is exhausted at the first natural frequency.
    assert!((speed / 3.516015268500612 - 1.0).abs() < 1e-5, "{speed}");
    let [critical] = diagram.criticals[..] else { panic!("{:?}", diagram.criticals) };
    assert!(critical.directions == 1 && (critical.speed / speed - 1.0).abs() < 1e-6);
    assert_eq!(diagram.speeds.last(), Some(&10.0));
    // λ² = Ω² − ω₁² grows without vibrating; the Coriolis force on the stiff axis makes 2Ω²/(π/2 · 1000)² of it.
    let last = diagram.branches[0].points.last().unwrap();
    let expected = (100.0 - 3.516015268500612_f64.powi(2)).sqrt();
    assert_eq!(last.mode.frequency(), 0.0);
    assert!((last.mode.eigenvalue.re / expected - 1.0).abs() < 1e-4, "{}", last.mode.eigenvalue);
}

/// A soft mode does not spoil the others: one part in 10⁵ below the critical speed ω₁ is a 220th of what it was.
#[test]
fn modes_are_found_right_up_to_a_divergence() {
    let critical = 3.516015268500612;
    let speeds = vec![3.0, 3.4, 3.51, 3.515, critical * (1.0 - 1e-5), 4.0];
    let plan = Plan { speeds: speeds.clone(), ..plan(1.0, 2, 6) };
    let diagram = campbell(beam(1000.0, Foreshortening::None), &plan, |_| true).unwrap();
    assert!(matches!(diagram.instabilities[..], [Instability::Divergence { .. }]));
    // ω₁² of the beam at rest less Ω². Of ω₁² twenty elements miss (βh)⁴/720 = 10⁻⁷, half a percent of the difference.
    let at = |p: &&flexion::analysis::campbell::Point| p.speed == speeds[4];
    let soft = diagram.branches[0].points.iter().find(at).unwrap().mode.frequency();
    assert!((soft / (critical * 2e-5_f64.sqrt()) - 1.0).abs() < 0.01, "{soft}");
}

#[test]
fn speeds_that_make_no_axis_are_refused() {
    for speeds in [vec![], vec![1.0], vec![2.0, 1.0], vec![-1.0, 1.0], vec![0.0, f64::NAN]] {
        let plan = Plan { speeds, ..plan(1.0, 2, 1) };
        let result = campbell(beam(70.0, Foreshortening::First), &plan, |_| true);
        assert_eq!(result, Err(NoCampbell::Speeds));
    }
}
