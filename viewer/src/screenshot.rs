//! Pictures of the whole window without a window: the same drawing, painted by [`Raster`].

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use eframe::egui::{Context, Pos2, RawInput, Rect, vec2};

use crate::app::Viewer;
use crate::raster::Raster;

/// Most pixels of a side.
pub const MOST_PIXELS: usize = 8192;
/// Panels know their sizes after the first drawing, and the view fits them after the next.
const PASSES: usize = 4;

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The system says no.
    #[error("{}: {why}", path.display())]
    Io {
        /// Which file or folder.
        path: PathBuf,
        /// What it says.
        why: std::io::Error,
    },
    /// The picture cannot be packed.
    #[error("{}: {why}", path.display())]
    Png {
        /// Which file.
        path: PathBuf,
        /// Why not.
        why: png::EncodingError,
    },
}

/// Takes pictures, one after another: fonts are kept.
#[derive(Debug)]
pub struct Camera {
    ctx: Context,
    raster: Raster,
    time_secs: f64,
    warm: bool,
}

impl Camera {
    /// For pictures of this width and height, pixels.
    pub fn new(size: [usize; 2]) -> Self {
        let ctx = Context::default();
        ctx.all_styles_mut(|style| style.animation_time = 0.0);
        Self { ctx, raster: Raster::new(size), time_secs: 0.0, warm: false }
    }

    /// Draws the window as it is.
    pub fn take(&mut self, viewer: &mut Viewer) -> &Raster {
        let passes = if self.warm { 2 } else { PASSES };
        self.warm = true;
        let [w, h] = self.raster.size().map(|side| side as f32);
        for pass in 0..passes {
            // What was fitted before the panels had their places is fitted again.
            let fit = viewer.fit;
            self.time_secs += 1.0 / 60.0;
            let scale = self.ctx.zoom_factor();
            let input = RawInput {
                screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(w, h) / scale)),
                time: Some(self.time_secs),
                focused: true,
                ..RawInput::default()
            };
            let mut output = self.ctx.run_ui(input, |ui| viewer.show(ui));
            self.raster.load(&output.textures_delta);
            output.textures_delta.clear();
            if pass + 1 < passes {
                viewer.fit |= fit;
                continue;
            }
            let shapes = std::mem::take(&mut output.shapes);
            let primitives = self.ctx.tessellate(shapes, output.pixels_per_point);
            self.raster.clear(self.ctx.global_style().visuals.panel_fill);
            self.raster.paint(&primitives, output.pixels_per_point);
        }
        &self.raster
    }
}

/// Writes a picture.
///
/// # Errors
/// A file that cannot be written.
pub fn write_png(raster: &Raster, path: &Path) -> Result<(), PictureError> {
    let refused = |why: png::EncodingError| PictureError::Png { path: path.to_owned(), why };
    let file = File::create(path).map_err(|why| PictureError::Io { path: path.to_owned(), why })?;
    let [w, h] = raster.size();
    let mut encoder = png::Encoder::new(BufWriter::new(file), w as u32, h as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(refused)?;
    writer.write_image_data(&raster.rgb()).map_err(refused)?;
    writer.finish().map_err(refused)
}

/// Writes one picture per frame into a folder, which is made: `frame_000000.png` and so on by the frame's number.
/// `frames`: the first and the exclusive end.
///
/// # Errors
/// A folder or file that cannot be written.
pub fn write_sequence(
    viewer: &mut Viewer,
    camera: &mut Camera,
    frames: std::ops::Range<usize>,
    folder: &Path,
) -> Result<(), PictureError> {
    std::fs::create_dir_all(folder).map_err(|why| PictureError::Io { path: folder.to_owned(), why })?;
    for frame in frames {
        viewer.playback.go_to(frame);
        write_png(camera.take(viewer), &folder.join(format!("frame_{frame:06}.png")))?;
    }
    Ok(())
}
