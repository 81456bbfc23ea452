//! Which requests are allowed, and the headers of every answer.
//!
//! | request with | refused with |
//! |---|---|
//! | a host that is not this server on loopback (another site's name that leads here) | 403 |
//! | the origin of another site | 403 |
//! | a path under `/api` without the token of this start | 401 |
//!
//! The token is 128 random bits, new at every start, and compared in constant time. It is accepted in the header
//! `Authorization`, and in an address only in that of the page itself, from which the page removes it. Below `/open` a
//! ticket is required in its place: see `tickets`.

use std::sync::Arc;
use std::time::Instant;

use armill_api::ApiError;
use armill_study::StudyError;
use axum::extract::{Request, State};
use axum::http::header::{
    AUTHORIZATION, CACHE_CONTROL, CONTENT_SECURITY_POLICY, HOST, ORIGIN, REFERRER_POLICY,
    X_CONTENT_TYPE_OPTIONS,
};
use axum::http::{HeaderMap, HeaderName, HeaderValue};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use subtle::ConstantTimeEq;

use crate::connections::Client;
use crate::error::SentError;

/// Bytes of a token: 128 bits.
const TOKEN_BYTES: usize = 16;

/// Where files are opened by a ticket.
pub(crate) const TICKETS: &str = "/open/";

/// What the page may load and who may show it: itself alone. Pictures of answers are data, workers are its own.
const POLICY: HeaderValue = HeaderValue::from_static(
    "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; worker-src 'self' blob:; \
     connect-src 'self'; frame-ancestors 'none'; base-uri 'none'",
);

/// What opens `/api`.
pub(crate) struct Token(String);

impl Token {
    /// A new one.
    ///
    /// # Errors
    /// The system gives no randomness.
    pub(crate) fn random() -> Result<Token, StudyError> {
        Ok(Token(random_hex()?))
    }

    /// In hexadecimal digits.
    pub(crate) fn shown(&self) -> &str {
        &self.0
    }

    fn is(&self, given: &str) -> bool {
        self.0.as_bytes().ct_eq(given.as_bytes()).into()
    }
}

/// 128 random bits, in hexadecimal digits.
///
/// # Errors
/// The system gives no randomness.
pub(crate) fn random_hex() -> Result<String, StudyError> {
    let mut bytes = [0; TOKEN_BYTES];
    getrandom::fill(&mut bytes).map_err(|error| {
        StudyError::value(
            format!("no random numbers for a token: {error}"),
            "check the random number source of the system",
        )
    })?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// What a request must show.
pub(crate) struct Guard {
    token: Token,
    hosts: [String; 2],
}

impl Guard {
    /// Of the server on this port.
    pub(crate) fn new(port: u16, token: Token) -> Guard {
        Guard {
            token,
            hosts: ["127.0.0.1", "localhost"].map(|name| format!("{name}:{port}")),
        }
    }

    fn knows(&self, host: &str) -> bool {
        self.hosts.iter().any(|known| known.eq_ignore_ascii_case(host))
    }

    /// Whether host and origin, where there is one, are ours.
    fn is_for_us(&self, request: &Request) -> bool {
        let hosts = all(request.headers(), &HOST);
        let host = matches!(hosts[..], [Some(host)] if self.knows(host));
        let authority = request.uri().authority().is_none_or(|to| self.knows(to.as_str()));
        let of_us = |origin: &Option<&str>| {
            let host = origin.and_then(|origin| origin.strip_prefix("http://"));
            host.is_some_and(|host| self.knows(host))
        };
        host && authority && all(request.headers(), &ORIGIN).iter().all(of_us)
    }

    /// Whether the token is there: in the header, or in the query of the page itself, the address that armill opens.
    fn has_token(&self, request: &Request) -> bool {
        let headers = all(request.headers(), &AUTHORIZATION);
        let mut borne = headers
            .iter()
            .filter_map(|header| (*header)?.strip_prefix("Bearer "));
        let query = match request.uri().path() {
            "/" => request.uri().query().unwrap_or_default(),
            _ => "",
        };
        let mut requested = query.split('&').filter_map(|pair| pair.strip_prefix("token="));
        borne.any(|token| self.token.is(token)) || requested.any(|token| self.token.is(token))
    }
}

/// Every value of a header; `None` for one that is not text.
fn all<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Vec<Option<&'a str>> {
    headers
        .get_all(name)
        .iter()
        .map(|value| value.to_str().ok())
        .collect()
}

/// Passes allowed requests on, and adds the security headers to every answer.
pub(crate) async fn check(State(guard): State<Arc<Guard>>, request: Request, next: Next) -> Response {
    let path = request.uri().path();
    let is_api = path == "/api" || path.starts_with("/api/");
    let is_ticket = path.starts_with(TICKETS);
    let begun = Instant::now();
    let is_for_us = guard.is_for_us(&request);
    let has_token = is_for_us && guard.has_token(&request);
    if let (true, Some(client)) = (has_token, request.extensions().get::<Client>()) {
        client.keep_place();
    }
    let mut response = if !is_for_us {
        SentError(ApiError::forbidden(
            "this server answers only its own page on this machine",
        ))
        .into_response()
    } else if is_api && !has_token {
        SentError(ApiError::unauthorised()).into_response()
    } else {
        next.run(request).await
    };
    let headers = response.headers_mut();
    headers.entry(CONTENT_SECURITY_POLICY).or_insert(POLICY);
    headers.insert(X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    headers.insert(REFERRER_POLICY, HeaderValue::from_static("no-referrer"));
    // The server's part of the waiting time: a browser shows it next to its own times.
    let took = format!("total;dur={:.2}", begun.elapsed().as_micros() as f64 / 1e3);
    if let (true, Ok(took)) = (is_api, HeaderValue::from_str(&took)) {
        headers.insert(HeaderName::from_static("server-timing"), took);
    }
    let kept = if is_api || is_ticket {
        "no-store"
    } else {
        "no-cache"
    };
    headers.insert(CACHE_CONTROL, HeaderValue::from_static(kept));
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tokens_are_128_bits_and_differ() {
        let (a, b) = (Token::random().unwrap(), Token::random().unwrap());
        assert_eq!(a.shown().len(), 32);
        assert!(a.shown().chars().all(|digit| digit.is_ascii_hexdigit()));
        assert_ne!(a.shown(), b.shown());
        assert!(a.is(a.shown()) && !a.is(b.shown()) && !a.is("") && !a.is(&a.shown()[..31]));
    }
}
