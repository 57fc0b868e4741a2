//! Fields stronger than a step can follow: the motion stays what they make of it, or the scene is refused.

use lamina2d::force::{Forces, Spring};

use super::case::{Case, Column, Expect, G, What, disc};

fn ball(velocity: [f64; 2]) -> lamina2d::scene::BodySpec {
    disc(0.1, [0.0, 0.0]).mass(1.0).moving(velocity, 0.0)
}

/// Falls against a drag of k kg/s: v = (m·g/k)(1 − exp(−k·t/m)).
fn drag(k: f64) -> Case {
    let secs = 2.0;
    let fall = |t: f64| G / k * (t - (1.0 - (-k * t).exp()) / k);
    let speed = G / k * (1.0 - (-k * secs).exp());
    Case::new(format!("falls with a drag of {k} kg/s"), vec![ball([0.0; 2])], secs)
        .under(Forces { linear_drag: Some(k), ..Forces::gravity() })
        .end(0, Column::Vy, -speed, 0.01 * speed)
        .end(0, Column::Y, -fall(secs), 0.02 * fall(secs))
}

/// Falls against k kg/m: v = √(m·g/k)·tanh(t·√(g·k/m)).
fn quadratic(k: f64) -> Case {
    let (secs, last) = (2.0, (G / k).sqrt());
    Case::new(format!("falls with a drag of {k} kg/m"), vec![ball([0.0; 2])], secs)
        .under(Forces { quadratic_drag: Some(k), ..Forces::gravity() })
        .end(0, Column::Vy, -last * (secs * (G * k).sqrt()).tanh(), 0.02 * last)
}

/// Drag brings a fast body to rest: x = m·v/k.
fn stop(k: f64) -> Case {
    Case::new(format!("100 m/s against a drag of {k} kg/s"), vec![ball([100.0, 0.0])], 1.0)
        .under(Forces { linear_drag: Some(k), ..Forces::default() })
        .end(0, Column::Vx, 100.0 * (-k).exp(), 0.01)
        .end(0, Column::X, 100.0 / k * (1.0 - (-k).exp()), 0.02 * 100.0 / k)
}

/// On a spring of k N/m from 1 m: it swings within a metre, with ½·k·1² at most.
fn spring(k: f64) -> Case {
    let body = disc(0.1, [1.0, 0.0]).mass(1.0);
    let case = Case::new(format!("spring of {k} N/m"), vec![body], 2.0)
        .under(Forces { spring: Some(Spring { anchor: [0.0; 2], stiffness: k }), ..Forces::default() });
    let x = case.last(0, Column::X);
    case.holds(Expect { tolerance: 0.02, ..Expect::at_most(x, 1.0) })
        .holds(Expect { tolerance: 0.02, ..Expect::at_least(x, -1.0) })
        .holds(Expect { tolerance: 0.01 * k, ..Expect::at_most(What::Kinetic, 0.5 * k) })
}

/// A magnet does no work: ½·m·v² stays.
fn magnet(k: f64) -> Case {
    Case::new(format!("magnetic field of {k} kg/s"), vec![ball([1.0, 0.0])], 2.0)
        .under(Forces { magnetic: Some(k), ..Forces::default() })
        .expect(What::KineticAlways, 0.5, 0.005)
}

pub(super) fn cases() -> Vec<Case> {
    let drags = [10.0, 500.0, 1e5].map(drag);
    drags
        .into_iter()
        .chain([0.1, 100.0, 1e4].map(quadratic))
        .chain([50.0, 5000.0].map(stop))
        .chain([1e4, 1e6, 1e9].map(spring))
        .chain([20.0, 2000.0, 1e5].map(magnet))
        .collect()
}
