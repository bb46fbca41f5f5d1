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

    /// Text.
    pub fn text(&mut self, text: &str) -> &mut Html {
        self.0.push_str(&escaped(text));
        self
    }

    /// An element with text in it; `marks` are its name and attributes.
    pub fn element(&mut self, marks: &str, text: &str) -> &mut Html {
        let name = marks.split(' ').next().unwrap_or(marks);
        let _ = write!(self.0, "<{marks}>{}</{name}>", escaped(text));
        self
    }
}

/// A text in which nothing is a mark.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
