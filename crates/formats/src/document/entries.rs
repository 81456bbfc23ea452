//! Entries of lists in a TOML text that is edited: a new one behind the last, one taken away, and the comments around
//! them.
//!
//! | comment | goes with |
//! |---|---|
//! | on the lines right above an entry | that entry |
//! | behind an entry, and on the lines right below it that a blank line follows | that entry |
//! | any other, as one with a blank line below it | no entry: it stays where it is |

use toml_edit::{Array, DocumentMut, Item, Table, Value};

use super::path::Step;

/// How many entries a list has; `None` of what is not a list.
pub(super) fn count(list: &Item) -> Option<usize> {
    match list {
        Item::ArrayOfTables(tables) => Some(tables.len()),
        Item::Value(Value::Array(entries)) => Some(entries.len()),
        _ => None,
    }
}

/// A new entry behind the last of this list; where it is a table of its own, [`settle`] finds its place in the text.
pub(super) fn append(list: &mut Item, entry: Value) -> Result<(), String> {
    match (list, entry) {
        (Item::ArrayOfTables(tables), Value::InlineTable(fields)) => tables.push(fields.into_table()),
        (Item::ArrayOfTables(_), _) => return Err("its entries are tables".to_owned()),
        (Item::Value(Value::Array(entries)), entry) => push(entries, entry),
        _ => return Err("it is not a list".to_owned()),
    }
    Ok(())
}

/// Removes this entry from its list; a missing one is not an error.
pub(super) fn take(list: &mut Item, index: usize) -> Result<(), String> {
    match list {
        Item::ArrayOfTables(tables) if index < tables.len() => drop(tables.remove(index)),
        Item::Value(Value::Array(entries)) if index < entries.len() => pull(entries, index),
        Item::ArrayOfTables(_) | Item::Value(Value::Array(_)) => (),
        _ => return Err("it is not a list".to_owned()),
    }
    Ok(())
}

/// Moves a table that was created without a position in the text behind the tables of the same list, and leaves
/// comments with the table that they describe.
pub(super) fn settle(document: &mut DocumentMut) {
    let (mut before, mut is_new) = (0, false);
    headers(document.as_table_mut(), &mut |table| match table.position() {
        Some(at) if !is_new => before = at,
        Some(_) => (),
        None => is_new = true,
    });
    if !is_new {
        return;
    }
    let mut about_before = String::new();
    change_above(document, before + 1, |above, ends| {
        let (own, others) = above.split_at(own_lines(above, ends));
        about_before = own.to_owned();
        others.to_owned()
    });
    headers(document.as_table_mut(), &mut |table| {
        if table.position().is_none() {
            table.set_position(Some(before));
            if !about_before.is_empty() {
                let line_end = if about_before.ends_with('\n') { "" } else { "\n" };
                table
                    .decor_mut()
                    .set_prefix(format!("{about_before}{line_end}\n"));
            }
        }
    });
}

/// Comments above a table that do not describe it, and their position in the text.
pub(super) struct UnrelatedComments {
    position: isize,
    comments: String,
}

/// Those of the entry at these steps, where it has a header.
pub(super) fn others(root: &Item, steps: &[Step]) -> Option<UnrelatedComments> {
    let entry = steps.iter().try_fold(root, |here, step| match step {
        Step::Key(key) => here.get(key.as_str()),
        Step::Entry(index) => here.get(*index),
    });
    let table = entry?.as_table()?;
    let above = table.decor().prefix()?.as_str()?;
    // Those before the last blank line.
    let (mut blank, mut at) = (0, 0);
    for line in above.split_inclusive('\n') {
        if line.ends_with('\n') && line.trim().is_empty() {
            blank = at;
        }
        at += line.len();
    }
    let comments = above[..blank].to_owned();
    Some(UnrelatedComments {
        position: table.position()?,
        comments,
    })
    .filter(|others| !others.comments.trim().is_empty())
}

/// Inserts them again above what is now at their position.
pub(super) fn put_back(document: &mut DocumentMut, others: &UnrelatedComments) {
    change_above(document, others.position, |above, _| {
        format!("{}{above}", others.comments)
    });
}

/// Bytes of the lines that describe what is above them: up to the first blank line, or to the end of the text.
fn own_lines(text: &str, ends: bool) -> usize {
    let mut own = 0;
    for line in text.split_inclusive('\n') {
        if line.trim().is_empty() {
            return own;
        }
        own += line.len();
    }
    // Without a blank line they are about the header below.
    if ends { own } else { 0 }
}

/// Changes the text above the first header at this position or behind it; without one, the end of the text. `change`
/// receives whether it is the end.
fn change_above(document: &mut DocumentMut, from: isize, mut change: impl FnMut(&str, bool) -> String) {
    let mut next: Option<isize> = None;
    headers(document.as_table_mut(), &mut |table| {
        let at = table.position().filter(|at| *at >= from);
        next = [next, at].into_iter().flatten().min();
    });
    let Some(next) = next else {
        let end = document.trailing().as_str().unwrap_or_default().to_owned();
        document.set_trailing(change(&end, true));
        return;
    };
    let mut done = false;
    headers(document.as_table_mut(), &mut |table| {
        if table.position() == Some(next) && !done {
            let decor = table.decor_mut();
            let above = decor
                .prefix()
                .and_then(|above| above.as_str())
                .unwrap_or_default();
            let above = change(above, false);
            decor.set_prefix(above);
            done = true;
        }
    });
}

/// Every table below this one that has a header.
fn headers<F: FnMut(&mut Table)>(table: &mut Table, visit: &mut F) {
    for (_, item) in table.iter_mut() {
        match item {
            Item::Table(table) => {
                if !table.is_dotted() && !table.is_implicit() {
                    visit(table);
                }
                headers(table, visit);
            }
            Item::ArrayOfTables(tables) => {
                for table in tables.iter_mut() {
                    visit(table);
                    headers(table, visit);
                }
            }
            Item::None | Item::Value(_) => (),
        }
    }
}

/// A new entry at the end of a list on a line, or of one with a line for each.
fn push(entries: &mut Array, mut entry: Value) {
    let begin = entries.iter().last().map_or_else(String::new, above);
    let tail = tail(entries);
    let by_lines = begin.contains('\n') || tail.contains('\n');
    if entries.is_empty() || !by_lines {
        entries.push(entry);
        return;
    }
    let indent = begin.rsplit_once('\n').map_or("  ", |(_, indent)| indent);
    entry
        .decor_mut()
        .set_prefix(format!("{}\n{indent}", tail.trim_end()));
    if let Some(last) = entries.iter_mut().last() {
        last.decor_mut().set_suffix("");
    }
    let closing = tail.rfind('\n').map_or("", |at| &tail[at..]);
    entries.set_trailing(closing);
    entries.set_trailing_comma(true);
    entries.push_formatted(entry);
}

/// Removes an entry from a list: text behind the entry before it, on its line, stays there.
fn pull(entries: &mut Array, index: usize) {
    let is_last = index + 1 == entries.len();
    let before = entries.get(index).map_or_else(String::new, above);
    let behind = match entries.get(index + 1) {
        Some(next) => above(next),
        None => tail(entries),
    };
    entries.remove(index);
    let of_before = before.find('\n').map(|at| before.split_at(at).0);
    let joined = match (of_before, behind.find('\n')) {
        (of_before, Some(at)) => format!("{}{}", of_before.unwrap_or_default(), &behind[at..]),
        (Some(of_before), None) if is_last && of_before.contains('#') => format!("{of_before}\n"),
        (_, None) if is_last => behind,
        (_, None) => before,
    };
    match entries.get_mut(index) {
        Some(next) => next.decor_mut().set_prefix(joined),
        None => entries.set_trailing(joined),
    }
}

/// What precedes this entry, from the comma of the one before it on.
fn above(entry: &Value) -> String {
    let prefix = entry.decor().prefix().and_then(|prefix| prefix.as_str());
    prefix.unwrap_or_default().to_owned()
}

/// What is between the last entry and the end of the list, but for a comma.
fn tail(entries: &Array) -> String {
    let last = entries.iter().last().filter(|_| !entries.trailing_comma());
    let suffix = last.and_then(|last| last.decor().suffix()?.as_str());
    let end = entries.trailing().as_str();
    format!("{}{}", suffix.unwrap_or_default(), end.unwrap_or_default())
}
