//! Draws egui's triangles without a graphics card: exact edges on a grid of 1/256 pixel, so that triangles that share
//! an edge share no pixel, and colours blended as egui's own painters blend them.

use std::collections::BTreeMap;

use eframe::egui::epaint::{ImageData, ImageDelta, Mesh, Primitive, Vertex};
use eframe::egui::{ClippedPrimitive, Color32, Pos2, Rect, TextureId, TexturesDelta};

/// Steps of a pixel that corners are rounded to.
const GRID: f32 = 256.0;

/// A texture: width, height, texels row by row, premultiplied.
#[derive(Debug, Default)]
struct Texture {
    size: [usize; 2],
    texels: Vec<Color32>,
}

impl Texture {
    /// The colour between the four nearest texels, 0 to 255 each.
    fn at(&self, uv: [f32; 2]) -> [f32; 4] {
        let Some(&first) = self.texels.first() else { return [255.0; 4] };
        let [w, h] = self.size;
        let place = |share: f32, count: usize| {
            let at = (share * count as f32 - 0.5).clamp(0.0, (count - 1) as f32);
            (at as usize, (at as usize + 1).min(count - 1), at.fract())
        };
        let ((x0, x1, fx), (y0, y1, fy)) = (place(uv[0], w), place(uv[1], h));
        let texel =
            |x: usize, y: usize| self.texels.get(y * w + x).unwrap_or(&first).to_array().map(f32::from);
        let mix = |a: [f32; 4], b: [f32; 4], t: f32| [0, 1, 2, 3].map(|k| a[k] + (b[k] - a[k]) * t);
        if fx == 0.0 && fy == 0.0 {
            return texel(x0, y0);
        }
        mix(mix(texel(x0, y0), texel(x1, y0), fx), mix(texel(x0, y1), texel(x1, y1), fx), fy)
    }
}

/// A picture that meshes are painted on.
#[derive(Debug)]
pub struct Raster {
    size: [usize; 2],
    pixels: Vec<[f32; 4]>,
    textures: BTreeMap<TextureId, Texture>,
}

impl Raster {
    /// A black picture. `size`: width and height, pixels.
    pub fn new(size: [usize; 2]) -> Self {
        let pixels = vec![[0.0, 0.0, 0.0, 255.0]; size[0] * size[1]];
        Self { size, pixels, textures: BTreeMap::new() }
    }

    /// Makes the picture one colour.
    pub fn clear(&mut self, color: Color32) {
        self.pixels.fill(color.to_array().map(f32::from));
    }

    /// Width and height, pixels.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Red, green, blue, row by row.
    pub fn rgb(&self) -> Vec<u8> {
        self.pixels
            .iter()
            .flat_map(|[r, g, b, _]| [r, g, b].map(|value| value.round().clamp(0.0, 255.0) as u8))
            .collect()
    }

    /// Takes over new and changed textures.
    #[expect(clippy::iter_over_hash_type, reason = "each texture changes by itself")]
    pub fn load(&mut self, delta: &TexturesDelta) {
        for (id, changes) in &delta.set {
            let texture = self.textures.entry(*id).or_default();
            changes.iter().for_each(|change| texture.apply(change));
        }
    }

    /// Paints what egui has tessellated; `scale`: pixels per point.
    pub fn paint(&mut self, primitives: &[ClippedPrimitive], scale: f32) {
        for primitive in primitives {
            if let Primitive::Mesh(mesh) = &primitive.primitive {
                self.mesh(mesh, primitive.clip_rect, scale);
            }
        }
    }

    fn mesh(&mut self, mesh: &Mesh, clip: Rect, scale: f32) {
        let bound = |value: f32, most: usize| (value * scale).round().clamp(0.0, most as f32) as i64;
        let [w, h] = self.size;
        let clip = [bound(clip.min.x, w), bound(clip.min.y, h), bound(clip.max.x, w), bound(clip.max.y, h)];
        let nothing = Texture::default();
        let texture = self.textures.get(&mesh.texture_id).unwrap_or(&nothing);
        let mut target = Target { pixels: &mut self.pixels, width: w, clip, texture, scale };
        for corners in mesh.indices.chunks_exact(3) {
            let corner = |k: usize| mesh.vertices.get(corners[k] as usize);
            if let (Some(a), Some(b), Some(c)) = (corner(0), corner(1), corner(2)) {
                target.triangle([a, b, c]);
            }
        }
    }
}

impl Texture {
    fn apply(&mut self, change: &ImageDelta) {
        let ImageData::Color(image) = &change.image;
        let Some([x, y]) = change.pos else {
            (self.size, self.texels) = (image.size, image.pixels.clone());
            return;
        };
        for (row, texels) in image.pixels.chunks_exact(image.size[0].max(1)).enumerate() {
            let start = (y + row) * self.size[0] + x;
            if let Some(into) = self.texels.get_mut(start..start + texels.len()) {
                into.copy_from_slice(texels);
            }
        }
    }
}

/// Where a mesh goes.
struct Target<'a> {
    pixels: &'a mut [[f32; 4]],
    width: usize,
    /// Least x and y, and the exclusive ends, pixels.
    clip: [i64; 4],
    texture: &'a Texture,
    scale: f32,
}

/// Twice the area of a triangle, positive where it turns as x to y does.
fn area(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Does a pixel centre on this edge belong to the triangle? To exactly one of the two that share it.
fn owns(a: [i64; 2], b: [i64; 2]) -> bool {
    b[1] < a[1] || (b[1] == a[1] && b[0] > a[0])
}

impl Target<'_> {
    fn grid(&self, at: Pos2) -> Option<[i64; 2]> {
        let snap = |value: f32| {
            let snapped = (value * self.scale * GRID).round();
            (snapped.abs() < 1e9).then_some(snapped as i64)
        };
        Some([snap(at.x)?, snap(at.y)?])
    }

    fn triangle(&mut self, corners: [&Vertex; 3]) {
        let [Some(a), Some(b), Some(c)] = corners.map(|corner| self.grid(corner.pos)) else { return };
        let (mut at, mut of) = ([a, b, c], corners);
        if area(a, b, c) < 0 {
            at.swap(1, 2);
            of.swap(1, 2);
        }
        let clip = self.clip;
        let whole = area(at[0], at[1], at[2]);
        if whole == 0 {
            return;
        }
        let span = |axis: usize| {
            let values = at.map(|corner| corner[axis]);
            let least = values.iter().min().copied().unwrap_or(0).div_euclid(GRID as i64);
            let most = values.iter().max().copied().unwrap_or(0).div_euclid(GRID as i64) + 1;
            least.clamp(clip[axis], clip[axis + 2])..most.clamp(clip[axis], clip[axis + 2])
        };
        let (xs, ys) = (span(0), span(1));
        let least = [(1, 2), (2, 0), (0, 1)].map(|(from, to)| i64::from(!owns(at[from], at[to])));
        let half = GRID as i64 / 2;
        let flat = of[0].uv == of[1].uv && of[1].uv == of[2].uv;
        let plain = flat.then(|| self.texture.at(of[0].uv.into()));
        for y in ys {
            for x in xs.clone() {
                let p = [x * GRID as i64 + half, y * GRID as i64 + half];
                let parts = [area(at[1], at[2], p), area(at[2], at[0], p), area(at[0], at[1], p)];
                if parts.iter().zip(least).all(|(part, least)| *part >= least) {
                    let weights = parts.map(|part| part as f32 / whole as f32);
                    self.blend(x as usize, y as usize, of, weights, plain);
                }
            }
        }
    }

    fn blend(&mut self, x: usize, y: usize, of: [&Vertex; 3], weights: [f32; 3], plain: Option<[f32; 4]>) {
        let mix = |values: [f32; 3]| values[0] * weights[0] + values[1] * weights[1] + values[2] * weights[2];
        let texel = plain.unwrap_or_else(|| {
            self.texture.at([mix(of.map(|corner| corner.uv.x)), mix(of.map(|corner| corner.uv.y))])
        });
        let colors = of.map(|corner| corner.color.to_array().map(f32::from));
        let color = [0, 1, 2, 3].map(|k| mix(colors.map(|color| color[k])) * texel[k] / 255.0);
        let kept = 1.0 - color[3] / 255.0;
        if let Some(pixel) = self.pixels.get_mut(y * self.width + x) {
            for k in 0..4 {
                pixel[k] = color[k] + pixel[k] * kept;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::epaint::WHITE_UV;

    use super::*;

    #[test]
    fn triangles_that_share_an_edge_share_no_pixel() {
        let mut raster = Raster::new([40, 30]);
        let mut mesh = Mesh::default();
        let color = Color32::from_rgba_premultiplied(100, 0, 0, 128);
        for [x, y] in [[2.3, 1.7], [37.1, 4.2], [30.4, 27.9], [4.5, 22.2]] {
            mesh.vertices.push(Vertex { pos: Pos2::new(x, y), uv: WHITE_UV, color });
        }
        mesh.indices = vec![0, 1, 2, 0, 2, 3];
        raster.mesh(&mesh, Rect::EVERYTHING, 1.0);
        let reds: Vec<u32> = raster.rgb().chunks_exact(3).map(|pixel| pixel[0].into()).collect();
        assert!(reds.iter().all(|red| *red == 0 || *red == 100), "no pixel is painted twice");
        let inside = reds.iter().filter(|red| **red == 100).count();
        assert!((600..800).contains(&inside), "{inside}");
    }
}
