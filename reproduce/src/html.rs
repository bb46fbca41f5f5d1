//! Text for a page: nothing of it is read as marks.

use std::fmt::Write as _;

/// A page that is written part by part.
#[derive(Default)]
pub struct Html(pub String);

impl Html {
    /// Marks, as they are.
    pub fn raw(&mut self, marks: &str) -> &mut Html {
        self.0.push_str(marks);
        self
    }

    /// Text, with code between backquotes.
    pub fn text(&mut self, text: &str) -> &mut Html {
        self.0.push_str(&prose(text));
        self
    }

    /// An element with text in it; `marks` are its name and attributes.
    pub fn element(&mut self, marks: &str, text: &str) -> &mut Html {
        let name = marks.split(' ').next().unwrap_or(marks);
        let text = if name == "pre" { escaped(text) } else { prose(text) };
        let _ = write!(self.0, "<{marks}>{text}</{name}>");
        self
    }
}

/// A text in which nothing is a mark.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A text in which nothing is a mark, with what stands between backquotes as code.
fn prose(text: &str) -> String {
    let parts: Vec<&str> = text.split('`').collect();
    if parts.len().is_multiple_of(2) {
        return escaped(text);
    }
    let part = |(i, part): (usize, &&str)| {
        if i % 2 == 1 { format!("<code>{}</code>", escaped(part)) } else { escaped(part) }
    };
    parts.iter().enumerate().map(part).collect()
}
