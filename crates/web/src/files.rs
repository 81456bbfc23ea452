//! Files of the study's folder: sent, uploaded. Never one outside of it.
//!
//! | path | does |
//! |---|---|
//! | `GET /api/files/PATH` | one file; what a browser can show is shown without scripts, the rest is to be saved |
//! | `PUT /api/files/NAME` | uploads a file, under a plain name |
//! | `POST /api/tickets` | an address that opens one file once, without the token |
//! | `GET /open/TICKET/NAME` | that file |
//!
//! Which paths are in the folder: see `folder` of `armill-api`.

use std::sync::Arc;
use std::time::Instant;

use armill_api::{ApiError, MOST_FILE_BYTES, check_name, file_path, uploaded};
use armill_formats::file::new_part;
use armill_study::StudyError;
use axum::body::Body;
use axum::extract::{Path as InPath, Query, Request, State as Shared};
use axum::http::StatusCode;
use axum::http::header::{CONTENT_DISPOSITION, CONTENT_LENGTH, CONTENT_SECURITY_POLICY, CONTENT_TYPE};
use axum::response::{IntoResponse, Response};
use futures_util::stream;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use tokio::io::{AsyncReadExt, AsyncWriteExt};

use crate::body::{JsonBody, Pieces};
use crate::error::{Answered, SentError};
use crate::guard::TICKETS;
use crate::reply::{json, media_type};
use crate::state::State;

/// Bytes read at a time.
const PIECE: usize = 256 << 10;
/// Endings that a browser shows.
const SHOWN: [&str; 5] = ["svg", "png", "csv", "json", "html"];
/// Policy of a file that is shown: in a frame of the page, with its own styles and pictures, and no scripts.
const SHOWN_POLICY: &str =
    "sandbox; default-src 'none'; img-src 'self' data:; style-src 'unsafe-inline'; frame-ancestors 'self'";

/// Options of an upload.
#[derive(Clone, Debug, Default, Deserialize)]
pub(crate) struct Taking {
    /// `1`: replaces a file of that name.
    replace: Option<String>,
}

/// A file to be opened.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct TicketRequest {
    /// The file, in the folder.
    pub path: String,
}

/// An address for a file.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct TicketAnswer {
    /// The address, on this server: it opens the file once, within a minute.
    pub address: String,
}

/// What is shown for a ticket that is used or too old.
const USED: &str = "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>armill</title>\
<p>This address has been used or is older than a minute. Open the file again on the page of armill.</p></html>";

pub(crate) async fn ticket(
    Shared(state): Shared<Arc<State>>,
    JsonBody(requested): JsonBody<TicketRequest>,
) -> Answered {
    let (context, path) = (Arc::clone(&state.context), requested.path);
    let work = move |_: armill_core::watch::Watch<'_>| {
        let found = file_path(&context.cell, &path);
        Ok((path, found))
    };
    let (path, found) = state.work.done(work).await?;
    found?;
    let name = path.rsplit('/').next().unwrap_or_default();
    let name = percent_encode(name);
    let ticket = state.tickets.issue(path, Instant::now())?;
    let address = format!("{TICKETS}{ticket}/{name}");
    Ok(json(StatusCode::OK, &TicketAnswer { address })?)
}

/// Every byte that is not a letter, a digit or one of `-._` as `%XX`.
fn percent_encode(name: &str) -> String {
    let encoded = |byte: u8| match byte {
        b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'.' | b'_' => char::from(byte).to_string(),
        _ => format!("%{byte:02X}"),
    };
    name.bytes().map(encoded).collect()
}

pub(crate) async fn open(
    Shared(state): Shared<Arc<State>>,
    InPath((ticket, _)): InPath<(String, String)>,
) -> Answered {
    match state.tickets.redeem(&ticket, Instant::now()) {
        Some(path) => send(&state, path).await,
        None => Ok((StatusCode::GONE, [(CONTENT_TYPE, media_type("used.html"))], USED).into_response()),
    }
}

pub(crate) async fn read(Shared(state): Shared<Arc<State>>, InPath(path): InPath<String>) -> Answered {
    send(&state, path).await
}

/// The file at this path of the folder.
async fn send(state: &Arc<State>, path: String) -> Answered {
    let context = Arc::clone(&state.context);
    let requested = path.clone();
    let real = state
        .work
        .done(move |_| Ok(file_path(&context.cell, &requested)))
        .await??;
    let none = |_| ApiError::not_found("there is no such file");
    let file = tokio::fs::File::open(&real).await.map_err(none)?;
    let length = file.metadata().await.map_err(none)?.len();
    // No more than was reported, should the file grow meanwhile.
    let pieces = stream::unfold((file, length), |(mut file, left)| async move {
        if left == 0 {
            return None;
        }
        let mut piece = vec![0; PIECE.min(usize::try_from(left).unwrap_or(PIECE))];
        match file.read(&mut piece).await {
            Ok(0) => Some((
                Err(std::io::Error::from(std::io::ErrorKind::UnexpectedEof)),
                (file, 0),
            )),
            Ok(read) => {
                piece.truncate(read);
                Some((Ok(piece), (file, left - read as u64)))
            }
            Err(error) => Some((Err(error), (file, 0))),
        }
    });
    let ending = real
        .extension()
        .and_then(|ending| ending.to_str())
        .unwrap_or_default();
    let shown = SHOWN.contains(&ending);
    let headers = [
        (
            CONTENT_TYPE,
            if shown {
                media_type(&path)
            } else {
                "application/octet-stream"
            }
            .to_owned(),
        ),
        (CONTENT_LENGTH, length.to_string()),
        (
            CONTENT_DISPOSITION,
            if shown { "inline" } else { "attachment" }.to_owned(),
        ),
        (CONTENT_SECURITY_POLICY, SHOWN_POLICY.to_owned()),
    ];
    let body: Body = Body::from_stream(pieces);
    Ok((headers, body).into_response())
}

pub(crate) async fn take(
    Shared(state): Shared<Arc<State>>,
    InPath(name): InPath<String>,
    Query(taking): Query<Taking>,
    request: Request,
) -> Result<Response, SentError> {
    let cell = &state.context.cell;
    check_name(cell, &name)?;
    let path = cell.root.join(&name);
    let replaces = taking.replace.as_deref() == Some("1");
    let taken = || ApiError::conflict(format!("the file `{name}` exists already"));
    // Also a link that leads nowhere is there.
    if path
        .symlink_metadata()
        .is_ok_and(|meta| !replaces || !meta.is_file())
    {
        return Err(taken().into());
    }
    let (parts, body) = request.into_parts();
    let mut pieces = Pieces::of(&parts.headers, body, MOST_FILE_BYTES)?;
    let failed = |error: std::io::Error| {
        ApiError::from(StudyError::value(
            format!("cannot write {name}: {error}"),
            "check the free disk space",
        ))
    };
    // Hidden until it is whole, and removed if this ends early; after a kill the next start removes it.
    let part = new_part(&cell.root).map_err(failed)?;
    let mut file = tokio::fs::File::from_std(part.as_file().try_clone().map_err(failed)?);
    let mut bytes = 0;
    while let Some(piece) = pieces.next().await? {
        file.write_all(&piece).await.map_err(failed)?;
        bytes += piece.len() as u64;
    }
    file.flush().await.map_err(failed)?;
    file.sync_all().await.map_err(failed)?;
    let at = path.clone();
    let placed = tokio::task::spawn_blocking(move || match replaces {
        true => part.persist(&at),
        false => part.persist_noclobber(&at),
    });
    match placed.await {
        Ok(Ok(_)) => {}
        Ok(Err(error)) if error.error.kind() == std::io::ErrorKind::AlreadyExists => {
            return Err(taken().into());
        }
        Ok(Err(error)) => return Err(failed(error.error).into()),
        Err(_) => {
            return Err(ApiError::internal("internal error of armill while a file was uploaded").into());
        }
    }
    let taken = uploaded(&path, name, bytes);
    Ok(json(StatusCode::CREATED, &taken)?)
}
