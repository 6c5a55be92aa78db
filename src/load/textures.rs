//! The textures of a model: each picture decoded once for each way it is sampled, within the model's budget.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::Arc;

use super::budget::Budget;
use super::{base64, referenced};
use crate::space::{Sampler, Texture};
use crate::surface::Pixmap;

/// Where a picture is.
pub(super) enum Place<'a> {
    /// Bytes of the model.
    Bytes(&'a [u8]),
    /// A `data:` URI.
    Data(&'a str),
    /// A file, by its name from the model's folder.
    File(String),
}

/// A place as it is compared: bytes by where they lie.
#[derive(PartialEq, Eq, Hash)]
enum Key<'a> {
    Bytes(usize, usize),
    Data(&'a str),
    File(String),
}

/// The textures so far: files may name one picture a thousand times.
pub(super) struct Textures<'a> {
    folder: Option<&'a Path>,
    done: HashMap<(Key<'a>, Sampler), Option<Arc<Texture>>>,
    /// Files that count already.
    files: HashSet<String>,
}

impl<'a> Textures<'a> {
    pub(super) fn new(folder: Option<&'a Path>) -> Self {
        Self { folder, done: HashMap::new(), files: HashSet::new() }
    }

    /// A picture as a texture, smaller where it would take more than what is left; `None` if it cannot be had. Warnings say so,
    /// and begin with `name`.
    pub(super) fn get(
        &mut self,
        name: &str,
        place: Place<'a>,
        sampler: Sampler,
        budget: &mut Budget,
        warnings: &mut Vec<String>,
    ) -> Option<Arc<Texture>> {
        let key = match &place {
            Place::Bytes(bytes) => Key::Bytes(bytes.as_ptr() as usize, bytes.len()),
            Place::Data(uri) => Key::Data(uri),
            Place::File(file) => Key::File(file.clone()),
        };
        let key = (key, sampler);
        if let Some(texture) = self.done.get(&key) {
            return texture.clone();
        }
        let texture = match self.load(&place, sampler, budget) {
            Ok((texture, full)) => {
                let size = texture.size();
                if size != full {
                    let [width, height, _] = full;
                    warnings.push(format!(
                        "{name} of {width} × {height} texels takes more than 64 times the size of the model's files; it is made {} × {}",
                        size[0], size[1]
                    ));
                }
                Some(Arc::new(texture))
            }
            Err(text) => {
                warnings.push(format!("{name} is left out: {text}"));
                None
            }
        };
        self.done.insert(key, texture.clone());
        texture
    }

    /// The texture and the size that its picture has.
    fn load(
        &mut self,
        place: &Place<'_>,
        sampler: Sampler,
        budget: &mut Budget,
    ) -> std::result::Result<(Texture, [u32; 3]), String> {
        let bytes = match place {
            Place::Bytes(bytes) => Cow::Borrowed(*bytes),
            Place::Data(uri) => Cow::Owned(base64::data_uri(uri).ok_or_else(|| "broken data URI".to_owned())?),
            Place::File(file) => {
                let bytes = referenced(self.folder, file)?;
                if self.files.insert(file.clone()) {
                    budget.add_file(bytes.len());
                }
                Cow::Owned(bytes)
            }
        };
        let named = |error: crate::error::Error| match place {
            Place::File(file) => format!("{file}: {error}"),
            _ => error.to_string(),
        };
        let pixmap = Pixmap::decode_within(&bytes, budget.for_decoding() as u64).map_err(named)?;
        let full = [pixmap.width(), pixmap.height(), 1];
        let texture = Texture::within(pixmap, sampler, budget.left()).map_err(named)?;
        budget.take(texture.bytes(), "its textures").map_err(named)?;
        Ok((texture, full))
    }
}
