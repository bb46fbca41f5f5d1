//! Texts in YAML as a tree with lines. Aliases share what they stand for.

use saphyr_parser::{Event, Parser};
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

/// Depth of nesting that is read.
const DEEPEST: usize = 64;

/// A value with its line.
#[derive(Debug)]
pub(super) struct Node {
    pub line: usize,
    pub value: Value,
}

#[derive(Debug)]
pub(super) enum Value {
    Scalar(String),
    List(Vec<Rc<Node>>),
    Map(Vec<(String, Rc<Node>)>),
}

/// A list or a map that is not yet closed, with its anchor and, in a map, its keys and the one that waits for its value.
struct Open {
    node: Node,
    anchor: usize,
    keys: HashSet<String>,
    key: Option<String>,
}

/// The first document of a text.
pub(super) fn read(text: &str, name: &str) -> Result<Rc<Node>, String> {
    let (mut open, mut anchors): (Vec<Open>, HashMap<usize, Rc<Node>>) = (Vec::new(), HashMap::new());
    for event in Parser::new_from_str(text) {
        let (event, span) = event.map_err(|error| format!("{name} is not YAML: {error}"))?;
        let line = span.start.line();
        let begun = |value: Value, anchor: usize| {
            let (keys, key) = (HashSet::new(), None);
            Open { node: Node { line, value }, anchor, keys, key }
        };
        let (done, anchor) = match event {
            Event::SequenceStart(anchor, _) => {
                open.push(begun(Value::List(Vec::new()), anchor));
                (None, 0)
            }
            Event::MappingStart(anchor, _) => {
                open.push(begun(Value::Map(Vec::new()), anchor));
                (None, 0)
            }
            Event::Scalar(text, _, anchor, _) => {
                (Some(Rc::new(Node { line, value: Value::Scalar(text.into_owned()) })), anchor)
            }
            Event::Alias(anchor) => {
                let unknown = || format!("line {line} of {name}: an alias of no anchor");
                (Some(Rc::clone(anchors.get(&anchor).ok_or_else(unknown)?)), 0)
            }
            Event::SequenceEnd | Event::MappingEnd => match open.pop() {
                Some(closed) => (Some(Rc::new(closed.node)), closed.anchor),
                None => (None, 0),
            },
            Event::Nothing
            | Event::StreamStart
            | Event::StreamEnd
            | Event::DocumentStart(_)
            | Event::DocumentEnd => (None, 0),
        };
        if open.len() > DEEPEST {
            return Err(format!("line {line} of {name}: nested more than {DEEPEST} times"));
        }
        let Some(node) = done else { continue };
        if anchor > 0 {
            anchors.insert(anchor, Rc::clone(&node));
        }
        let Some(outer) = open.last_mut() else { return Ok(node) };
        match (&mut outer.node.value, outer.key.take()) {
            (Value::List(items), _) => items.push(node),
            (Value::Map(entries), Some(key)) => entries.push((key, node)),
            (Value::Map(_), None) => match &node.value {
                Value::Scalar(key) if !outer.keys.insert(key.clone()) => {
                    return Err(format!("line {line} of {name}: the key `{key}` stands twice in one table"));
                }
                Value::Scalar(key) => outer.key = Some(key.clone()),
                _ => return Err(format!("line {line} of {name}: a key is a word")),
            },
            (Value::Scalar(_), _) => {}
        }
    }
    Err(format!("{name} is empty"))
}

impl Node {
    /// What stands under a key.
    pub fn get(&self, key: &str) -> Option<&Node> {
        match &self.value {
            Value::Map(entries) => entries.iter().find(|(k, _)| k == key).map(|(_, node)| &**node),
            _ => None,
        }
    }

    /// Its keys.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        let entries = match &self.value {
            Value::Map(entries) => &entries[..],
            _ => &[],
        };
        entries.iter().map(|(key, _)| key.as_str())
    }

    /// What stands under keys, one within the other.
    pub fn at(&self, path: &[&str]) -> Option<&Node> {
        path.iter().try_fold(self, |node, key| node.get(key))
    }

    /// The items of a list.
    pub fn items(&self) -> &[Rc<Node>] {
        match &self.value {
            Value::List(items) => items,
            _ => &[],
        }
    }

    /// The number of a scalar.
    pub fn number(&self) -> Option<f64> {
        match &self.value {
            Value::Scalar(text) => text.parse().ok().filter(|x: &f64| x.is_finite()),
            _ => None,
        }
    }

    /// The numbers of a list; an error names the `what` of the file.
    pub fn numbers(&self, name: &str, what: &str) -> Result<Vec<f64>, String> {
        let number = |(i, node): (usize, &Rc<Node>)| {
            let wrong =
                || format!("line {} of {name}: value {} of `{what}` is not a number", node.line, i + 1);
            node.number().ok_or_else(wrong)
        };
        match &self.value {
            Value::List(items) => items.iter().enumerate().map(number).collect(),
            _ => Err(format!("line {} of {name}: `{what}` is a list of numbers", self.line)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn aliases_stand_for_their_anchors_and_lines_are_known() {
        let text = "a: &x\n  grid: [0, 0.5,\n         1.0e0]\nb: *x\nc: {grid: &g [2]}\nd: *g\n";
        let tree = read(text, "f").unwrap();
        for path in [["a", "grid"], ["b", "grid"]] {
            let node = tree.at(&path).unwrap();
            assert_eq!((node.numbers("f", "grid").unwrap(), node.line), (vec![0.0, 0.5, 1.0], 2));
        }
        assert_eq!(tree.get("d").unwrap().numbers("f", "d").unwrap(), [2.0]);
        assert!(tree.at(&["c", "none"]).is_none() && tree.get("a").unwrap().number().is_none());
        for (text, says) in
            [("a: [1, x]", "value 2 of `a` is not a number"), ("a: 3", "is a list of numbers")]
        {
            let message = read(text, "f").unwrap().get("a").unwrap().numbers("f", "a").unwrap_err();
            assert!(message.contains(says), "{message}");
        }
        let [deep, deeper] = [100, 100_000].map(|n| "[".repeat(n));
        for (text, says) in [
            ("", "is empty"),
            ("a: [1", "is not YAML"),
            ("a: *x", "is not YAML"),
            ("a: 1\nb: {a: 2, c: 3, a: 4}", "line 2 of f: the key `a` stands twice"),
            (&*deep, "nested more than"),
            (&*deeper, "is not YAML"),
        ] {
            let message = read(text, "f").unwrap_err();
            assert!(message.contains(says), "{message}");
        }
        // Nine levels of nine aliases each: as a tree without sharing 4·10⁸ values.
        let mut bomb = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]\n".to_owned();
        for k in 1..10 {
            bomb += &format!("a{k}: &a{k} [{}]\n", vec![format!("*a{}", k - 1); 9].join(", "));
        }
        assert_eq!(read(&bomb, "f").unwrap().get("a9").unwrap().items().len(), 9);
    }
}
