//! The parts of a 3MF archive: named files, unpacked up to a limit.

use std::collections::BTreeMap;
use std::io::Read;

use flate2::bufread::DeflateDecoder;
use rawzip::{CompressionMethod, ZipArchive, ZipArchiveEntryWayfinder, ZipSliceArchive};

use crate::document::{Problem, Problems, Source};
use crate::xml;

/// All parts that are used may have this many bytes when unpacked: some 5 million triangles in XML.
const MOST_BYTES: u64 = 512 << 20;
/// An archive may have this many parts.
const MOST_PARTS: usize = 100_000;
/// The relationship of the archive to its model.
const MODEL: &str = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
/// The usual path of the model.
const USUAL_MODEL: &str = "3d/3dmodel.model";
/// What to do about an archive that cannot be read.
const DAMAGED: &str = "the archive is damaged: export it again";

/// An archive; names of parts are in small letters and without the first `/`, since their case does not matter.
pub(super) struct Package<'a> {
    archive: ZipSliceArchive<&'a [u8]>,
    parts: BTreeMap<String, Part>,
    /// Bytes that may still be unpacked.
    left: u64,
}

/// Where a part is.
struct Part {
    place: ZipArchiveEntryWayfinder,
    method: CompressionMethod,
    is_encrypted: bool,
}

/// The key of a part.
pub(super) fn key(path: &str) -> String {
    path.trim_start_matches('/').to_ascii_lowercase()
}

impl<'a> Package<'a> {
    /// The archive, with nothing unpacked.
    ///
    /// # Errors
    /// Not a zip archive; too many parts.
    pub fn open(name: &str, bytes: &'a [u8]) -> Result<Package<'a>, Problems> {
        let refused = |message: String, hint: &str| Problems::from(Problem::of_file(name, message, hint));
        let broken =
            |error: rawzip::Error| refused(format!("not a zip archive, as 3MF is: {error}"), DAMAGED);
        let archive = ZipArchive::from_slice(bytes).map_err(broken)?;
        let mut parts = BTreeMap::new();
        let mut entries = archive.entries();
        while let Some(entry) = entries.next_entry().map_err(broken)? {
            if parts.len() == MOST_PARTS {
                return Err(refused(
                    format!("more than {MOST_PARTS} parts in one archive"),
                    DAMAGED,
                ));
            }
            let part = Part {
                place: entry.wayfinder(),
                method: entry.compression_method(),
                is_encrypted: entry.flags().is_encrypted(),
            };
            let path = String::from_utf8_lossy(entry.file_path().as_bytes()).into_owned();
            parts.insert(key(&path), part);
        }
        Ok(Package {
            archive,
            parts,
            left: MOST_BYTES,
        })
    }

    /// The content of a part.
    ///
    /// # Errors
    /// No such part, encryption, another compression than deflate, damage, or more bytes than may be unpacked.
    pub fn part(&mut self, name: &str, path: &str) -> Result<Vec<u8>, Problems> {
        let refused = |message: String, hint: &str| {
            Problems::from(Problem::of_file(name, format!("part `{path}`: {message}"), hint))
        };
        let Some(part) = self.parts.get(&key(path)) else {
            return Err(refused("the archive does not contain it".to_owned(), DAMAGED));
        };
        if part.is_encrypted {
            return Err(refused(
                "it is encrypted".to_owned(),
                "export it without encryption",
            ));
        }
        let entry = self
            .archive
            .get_entry(part.place)
            .map_err(|error| refused(error.to_string(), DAMAGED))?;
        let packed: Box<dyn Read + '_> = match part.method {
            CompressionMethod::STORE => Box::new(entry.data()),
            CompressionMethod::DEFLATE => Box::new(DeflateDecoder::new(entry.data())),
            method => {
                let message = format!("its compression method {} is not known", method.as_u16());
                return Err(refused(message, "export it again: 3MF uses deflate"));
            }
        };
        let mut bytes = Vec::new();
        // One byte more, so that what is too long is seen; the length and the checksum are compared at the end.
        let read = entry
            .verifying_reader(packed)
            .take(self.left + 1)
            .read_to_end(&mut bytes);
        let length = bytes.len() as u64;
        if length > self.left {
            let message = format!("the archive has more than {MOST_BYTES} bytes when unpacked");
            return Err(refused(message, super::super::assembly::REDUCE));
        }
        read.map_err(|error| refused(format!("it cannot be unpacked: {error}"), DAMAGED))?;
        self.left -= length;
        Ok(bytes)
    }

    /// The key of the model that the archive is for.
    ///
    /// # Errors
    /// Relationships that are not XML.
    pub fn model_path(&mut self, name: &str) -> Result<String, Problems> {
        if !self.parts.contains_key("_rels/.rels") {
            return Ok(USUAL_MODEL.to_owned());
        }
        let bytes = self.part(name, "_rels/.rels")?;
        let source = Source::new(name, &String::from_utf8_lossy(&bytes));
        let document = xml::parse(&source)?;
        let path = xml::children(document.root_element(), "Relationship")
            .find(|relationship| relationship.attribute("Type") == Some(MODEL))
            .and_then(|relationship| relationship.attribute("Target"));
        Ok(path.map_or_else(|| USUAL_MODEL.to_owned(), key))
    }
}
