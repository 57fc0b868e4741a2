//! What flies, is stirred or pulled.

use lamina2d::force::{Forces, Spring};
use lamina2d::scene::named::scene;
use lamina2d::scene::{BodySpec, Scene, ShapeSpec, driven};

/// T14: `count` discs and boxes of 1 m in turn with their centres at one point, without gravity.
pub fn dense(count: f64) -> Scene {
    let bodies = (0..count as usize).map(|k| {
        let shape = if k % 2 == 0 { ShapeSpec::Circle(0.5) } else { ShapeSpec::Box([0.5; 2]) };
        BodySpec::new(shape, [0.0; 2]).surface(0.0, 0.6)
    });
    scene("bodies at one point", bodies.collect(), Forces::default(), 600)
}

/// T15: 625 discs of `radius` metres, 0.8 m apart, in a box of 20 m without gravity: from 0.4 m on they are squeezed.
pub fn confined(radius: f64) -> Scene {
    let mut scene = driven::circles_confined(1);
    for body in &mut scene.bodies {
        if let ShapeSpec::Circle(of) = &mut body.shape {
            *of = radius;
        }
    }
    scene
}

/// T17: `count` discs on a square grid, pulled to the origin by springs of 1 N/m each.
pub fn pulled(count: f64) -> Scene {
    let side = count.sqrt().ceil() as usize;
    let bodies = (0..count as usize).map(|k| {
        let at = |k: usize| (k as f64 - (side as f64 - 1.0) / 2.0) * 1.2;
        BodySpec::new(ShapeSpec::Circle(0.5), [at(k % side), at(k / side)]).surface(0.0, 0.6).mass(1.0)
    });
    let spring = Spring { anchor: [0.0; 2], stiffness: 1.0 };
    let forces = Forces { spring: Some(spring), ..Forces::default() };
    scene("discs pulled to the centre", bodies.collect(), forces, 3600)
}

/// T18: a disc of 0.1 m at `speed` m/s against a wall 0.1 m thick.
pub fn fired(speed: f64) -> Scene {
    scene(
        "a fast disc against a thin wall",
        driven::shot(ShapeSpec::Circle(0.1), 0.0, speed).to_vec(),
        Forces::default(),
        60,
    )
}

/// T19: a wedge at 200, a sliver and a plate at 100 m/s, times `share`, each against its own thin wall.
pub fn flung(share: f64) -> Scene {
    let [wedge, sliver, plate] = driven::projectiles();
    let shots = [
        driven::shot(wedge, 0.0, 200.0 * share),
        driven::shot(sliver, 10.0, 100.0 * share),
        driven::shot(plate, 20.0, 100.0 * share),
    ];
    scene("fast wedge, sliver and plate against thin walls", shots.concat(), Forces::default(), 60)
}

/// T20: a bar that stirs `count` small bodies in a closed box.
pub fn stirred(count: f64, seed: u64) -> Scene {
    driven::spinner(count as usize, seed)
}

/// T24: `count` boxes in a turning box; others come and go.
pub fn tumbling(count: f64) -> Scene {
    driven::tumbler(count as usize)
}

/// T25: a box of 10 m and 10 cm that turns with `rate` rad/s above a floor.
pub fn spun(rate: f64) -> Scene {
    let floor = BodySpec::new(ShapeSpec::Box([100.0, 0.5]), [0.0, -0.5]).surface(0.0, 0.6).fixed();
    let bar = BodySpec::new(ShapeSpec::Box([5.0, 0.05]), [0.0, 8.0]).surface(0.0, 0.6).moving([0.0; 2], rate);
    scene("a long box that turns fast", vec![floor, bar], Forces::gravity(), 600)
}

/// T27: twelve bodies of three shapes that drift apart with up to `speed` m/s and turn, without gravity.
pub fn drifting(speed: f64) -> Scene {
    let bodies = (0..12).map(|k| {
        let shape = match k % 3 {
            0 => ShapeSpec::Circle(0.5),
            1 => ShapeSpec::Box([0.5, 0.3]),
            _ => ShapeSpec::Polygon(vec![[0.6, 0.0], [-0.4, 0.5], [-0.4, -0.5]]),
        };
        let (s, c) = (f64::from(k) * std::f64::consts::TAU / 12.0).sin_cos();
        BodySpec::new(shape, [4.0 * c, 4.0 * s]).moving([speed * c, speed * s], 0.5 - f64::from(k) / 12.0)
    });
    scene("bodies that drift", bodies.collect(), Forces::default(), 3600)
}
