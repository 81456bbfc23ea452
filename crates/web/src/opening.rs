//! How the browser is opened at the page without other users being able to read the token.
//!
//! Arguments of programs can be read by every user of the machine. The program that opens the browser is therefore
//! given the name of a private file, a page that leads to the address. The file is removed when the browser has
//! requested the address, after [`PAGE_TIME`] at the latest; one that a killed server left is removed at the next
//! start.

use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use tempfile::TempDir;

/// How long the browser may take to open the file.
pub(crate) const PAGE_TIME: Duration = Duration::from_secs(60);
/// What the names of the folders with the files begin with, and the name of the file in each.
const FOLDER_PREFIX: &str = "armill-open-";
const PAGE_NAME: &str = "open-armill.html";

/// The file that is there for the browser, if any.
#[derive(Default)]
pub(crate) struct Opening(Mutex<Option<TempDir>>);

impl Opening {
    /// Writes the page that leads to `url`, and gives its path; removes those that killed servers left.
    ///
    /// # Errors
    /// No folder or file can be made.
    pub(crate) fn write(&self, url: &str) -> io::Result<PathBuf> {
        let folder = armill_api::private_folder(FOLDER_PREFIX)?;
        if let Some(parent) = folder.path().parent() {
            remove_abandoned_pages(parent, folder.path());
        }
        let path = folder.path().join(PAGE_NAME);
        let mut options = OpenOptions::new();
        options.write(true).create_new(true);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        options.open(&path)?.write_all(page(url).as_bytes())?;
        self.set(Some(folder));
        Ok(path)
    }

    /// Removes the file: the browser has requested the address, or will no longer do so.
    pub(crate) fn remove(&self) {
        self.set(None);
    }

    fn set(&self, folder: Option<TempDir>) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = folder;
    }
}

/// A page that leads to `url`.
fn page(url: &str) -> String {
    let url = escaped(url);
    format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>armill</title>\
         <meta name=\"referrer\" content=\"no-referrer\"><meta http-equiv=\"refresh\" content=\"0; url={url}\">\
         <p><a href=\"{url}\">Open armill</a></p></html>\n"
    )
}

/// A text inside quotes of an attribute.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('"', "&quot;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

/// Removes the pages in `parent` of this user that are older than any that is still in use.
fn remove_abandoned_pages(parent: &Path, own: &Path) {
    for entry in fs::read_dir(parent).into_iter().flatten().flatten() {
        let (path, name) = (entry.path(), entry.file_name());
        let is_page = name.to_string_lossy().starts_with(FOLDER_PREFIX) && path != own;
        if is_page && is_abandoned(&path, own) {
            // What cannot be removed stays: its token opens nothing any more.
            let _ = fs::remove_file(path.join(PAGE_NAME));
            let _ = fs::remove_dir(path);
        }
    }
}

/// Whether this is a folder of the user who made `own`, and older than [`PAGE_TIME`]. Links are not followed.
fn is_abandoned(folder: &Path, own: &Path) -> bool {
    let (Ok(it), Ok(own)) = (folder.symlink_metadata(), own.symlink_metadata()) else {
        return false;
    };
    #[cfg(unix)]
    let is_ours = {
        use std::os::unix::fs::MetadataExt;
        it.uid() == own.uid()
    };
    #[cfg(not(unix))]
    let is_ours = {
        // The folder for temporary files belongs to one user.
        let _ = own;
        true
    };
    let age = it.modified().ok().and_then(|at| at.elapsed().ok());
    it.is_dir() && is_ours && age.is_some_and(|age| age > 2 * PAGE_TIME)
}

#[cfg(test)]
mod tests {
    use super::*;

    const URL: &str = "http://127.0.0.1:8080/?token=0123";

    #[cfg(unix)]
    fn mode(path: &Path) -> u32 {
        std::os::unix::fs::PermissionsExt::mode(&path.metadata().unwrap().permissions()) & 0o777
    }

    #[test]
    fn the_page_leads_to_the_address_and_is_for_its_user_alone() {
        let opening = Opening::default();
        let path = opening.write(URL).unwrap();
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(&format!("content=\"0; url={URL}\"")), "{text}");
        assert!(text.contains(&format!("<a href=\"{URL}\">")), "{text}");
        let folder = path.parent().unwrap();
        #[cfg(unix)]
        assert_eq!((mode(folder), mode(&path)), (0o700, 0o600));
        opening.remove();
        assert!(!folder.exists());
    }

    #[test]
    fn an_address_stays_inside_its_quotes() {
        let text = page("http://h/?a=1&b=\"><script>");
        assert!(
            text.contains("href=\"http://h/?a=1&amp;b=&quot;&gt;&lt;script&gt;\""),
            "{text}"
        );
        assert!(!text.contains("<script"), "{text}");
    }

    #[cfg(unix)]
    #[test]
    fn pages_of_killed_servers_are_removed_and_nothing_else() {
        let parent = tempfile::tempdir().unwrap();
        let at = |name: &str| parent.path().join(name);
        let old = std::time::SystemTime::now() - 3 * PAGE_TIME;
        for name in [
            "armill-open-own",
            "armill-open-old",
            "armill-open-young",
            "armill-other",
            "armill-open-full",
        ] {
            fs::create_dir(at(name)).unwrap();
            fs::write(at(name).join(PAGE_NAME), "token").unwrap();
        }
        fs::write(at("armill-open-full").join("mine"), "mine").unwrap();
        fs::create_dir(at("elsewhere")).unwrap();
        fs::write(at("elsewhere").join(PAGE_NAME), "mine").unwrap();
        std::os::unix::fs::symlink(at("elsewhere"), at("armill-open-link")).unwrap();
        for name in [
            "armill-open-own",
            "armill-open-old",
            "armill-other",
            "armill-open-full",
            "elsewhere",
        ] {
            fs::File::open(at(name)).unwrap().set_modified(old).unwrap();
        }
        remove_abandoned_pages(parent.path(), &at("armill-open-own"));
        assert!(!at("armill-open-old").exists());
        for name in [
            "armill-open-own",
            "armill-open-young",
            "armill-other",
            "elsewhere",
        ] {
            assert!(at(name).join(PAGE_NAME).exists(), "{name}");
        }
        assert!(
            at("armill-open-full").join("mine").exists() && !at("armill-open-full").join(PAGE_NAME).exists()
        );
        assert!(at("armill-open-link").is_symlink());
    }
}
