//! Colours, dark and light. Hues are told apart by most eyes: blue, orange, green as Okabe and Ito chose them.

use eframe::egui::Color32;
use eframe::egui::epaint::Hsva;

/// The colours of one theme.
#[derive(Clone, Copy, Debug)]
pub struct Palette {
    /// Behind everything.
    pub back: Color32,
    /// Grid lines.
    pub grid: Color32,
    /// The two axes.
    pub axis: Color32,
    /// Words on the canvas.
    pub text: Color32,
    /// What never moves.
    pub fixed: Color32,
    /// What moves as it is told.
    pub kinematic: Color32,
    /// Circle, box, polygon.
    pub shapes: [Color32; 3],
    /// Asleep.
    pub asleep: Color32,
    /// The selected body.
    pub selected: Color32,
    /// Contact points.
    pub contact: Color32,
    /// Normals.
    pub normal: Color32,
    /// Contact points on A's and on B's surface.
    pub depths: [Color32; 2],
    /// Impulses.
    pub impulse: Color32,
    /// Joints.
    pub joint: Color32,
    /// Bounding circles.
    pub circle: Color32,
    /// Velocities.
    pub velocity: Color32,
    /// Rims are this much of their fill.
    rim: f32,
}

const fn rgb(hex: u32) -> Color32 {
    Color32::from_rgb((hex >> 16) as u8, (hex >> 8) as u8, hex as u8)
}

impl Palette {
    /// The dark or the light one.
    pub const fn of(dark: bool) -> Self {
        if dark { Self::DARK } else { Self::LIGHT }
    }

    const DARK: Self = Self {
        back: rgb(0x15_18_1d),
        grid: rgb(0x24_29_31),
        axis: rgb(0x3c_44_50),
        text: rgb(0x9a_a5_b3),
        fixed: rgb(0x4d_55_60),
        kinematic: rgb(0x8e_6a_b5),
        shapes: [rgb(0x3f_97_d6), rgb(0xe0_93_2f), rgb(0x35_ad_84)],
        asleep: rgb(0x5b_6b_8c),
        selected: rgb(0xff_e1_4d),
        contact: rgb(0xff_5a_5a),
        normal: rgb(0x7f_e0_ff),
        depths: [rgb(0xff_b0_e0), rgb(0xb6_ff_8a)],
        impulse: rgb(0xff_c2_4a),
        joint: rgb(0xd8_a8_ff),
        circle: rgb(0x70_7c_8c),
        velocity: rgb(0xe8_ec_f2),
        rim: 1.35,
    };
    const LIGHT: Self = Self {
        back: rgb(0xfb_fb_fc),
        grid: rgb(0xe6_e9_ed),
        axis: rgb(0xc2_c8_d0),
        text: rgb(0x55_5f_6b),
        fixed: rgb(0xa8_af_b8),
        kinematic: rgb(0xb0_90_d0),
        shapes: [rgb(0x56_b4_e9), rgb(0xf0_b0_50), rgb(0x4c_c0_9a)],
        asleep: rgb(0xb7_c3_d9),
        selected: rgb(0xd0_20_20),
        contact: rgb(0xd0_20_40),
        normal: rgb(0x00_60_a0),
        depths: [rgb(0xa0_00_80), rgb(0x30_70_00)],
        impulse: rgb(0xb0_60_00),
        joint: rgb(0x70_20_b0),
        circle: rgb(0x9a_a2_ad),
        velocity: rgb(0x20_24_2a),
        rim: 0.62,
    };

    /// The rim of a fill: lighter in the dark, darker in the light.
    pub fn rim(&self, fill: Color32) -> Color32 {
        let [r, g, b, a] = fill.to_array();
        let shade = |channel: u8| (f32::from(channel) * self.rim).min(255.0) as u8;
        Color32::from_rgba_premultiplied(shade(r), shade(g), shade(b), a)
    }

    /// Of an island, by its least slot: hues a golden angle apart, so that neighbours differ.
    pub fn island(&self, root: u32) -> Color32 {
        if root == 0 {
            return self.asleep;
        }
        let hue = (f64::from(root) * 0.618_033_988_749_895).fract() as f32;
        let [s, v] = if self.rim > 1.0 { [0.55, 0.8] } else { [0.45, 0.9] };
        Hsva::new(hue, s, v, 1.0).into()
    }

    /// Of a share from 0 to 1: from dark blue over green to yellow, of even steps in lightness (viridis).
    pub fn ramp(share: f64) -> Color32 {
        const STOPS: [u32; 6] = [0x44_01_54, 0x41_44_87, 0x2a_78_8e, 0x22_a8_84, 0x7a_d1_51, 0xfd_e7_25];
        let at = if share.is_finite() { share.clamp(0.0, 1.0) } else { 1.0 } * (STOPS.len() - 1) as f64;
        let low = (at as usize).min(STOPS.len() - 2);
        rgb(STOPS[low]).lerp_to_gamma(rgb(STOPS[low + 1]), (at - low as f64) as f32)
    }
}
