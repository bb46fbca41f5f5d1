//! Typed keys: one line declares a key and the field that is made of it.
//!
//! ```text
//! keys! {
//!     /// What a case says of a mass.
//!     struct Keys {
//!         /// station of a beam
//!         on: (usize, f64) = place();
//!         /// mass
//!         mass: f64 = quantity(&MASS, Positive);
//!         /// moment of inertia about its centre
//!         rotary_inertia: f64 = quantity(&INERTIA, NotNegative).or(0.0);
//!     }
//! }
//! ```
//!
//! The name of the key is that of its field, with hyphens; the comment is what listing, schema and messages say of it; the type of the
//! field says whether it may be left out.

use super::declaration::{Bound, Key, Presence, Type};
use super::fault::{At, Fault, Faults, Made};
use super::kind::{Choice, Context, Keys};
use super::places::Place;
use super::units::Measure;
use super::values::{Value, Values};
use flexion::linalg::Vec3;
use std::sync::Arc;

/// A key, and the field that is made of it.
#[derive(Clone, Copy)]
pub struct Field<T: 'static> {
    /// The key.
    pub key: Key,
    reader: &'static dyn Reader<T>,
}

/// Makes a field of the value of its key.
trait Reader<T> {
    /// The field; its faults are at paths within the key.
    fn read(&'static self, value: Option<&Value>, c: &Context<'_>) -> Made<T>;
}

impl<T> Field<T> {
    const fn new(takes: Type, presence: Presence, reader: &'static dyn Reader<T>) -> Field<T> {
        Field { key: Key { name: "", takes, presence, doc: "" }, reader }
    }

    /// The same under a name, with what it means.
    pub const fn called(mut self, name: &'static str, doc: &'static str) -> Field<T> {
        self.key.name = name;
        if !doc.is_empty() {
            self.key.doc = doc.trim_ascii_start();
        }
        self
    }

    /// The same, that must be written.
    pub const fn required(self) -> Field<T> {
        self.left_out(Presence::Required)
    }

    /// The same with a name where it is left out: a text, that of a choice, or of a kind with all its defaults.
    pub const fn or_name(self, name: &'static str) -> Field<T> {
        self.left_out(Presence::Name(name))
    }

    /// The same, empty where it is left out.
    pub const fn or_empty(self) -> Field<T> {
        self.left_out(Presence::Empty)
    }

    const fn left_out(mut self, presence: Presence) -> Field<T> {
        self.key.presence = presence;
        self
    }

    /// The name that is chosen.
    pub fn chosen_in<'v>(&self, v: &'v Values) -> Option<&'v str> {
        match &v.get(self.key.name)?.value {
            Value::Kind(entry, _) => Some(entry.name),
            Value::Text(name) => Some(name),
            _ => None,
        }
    }

    /// The values of its table, if it has a table.
    pub fn values_in<'v>(&self, v: &'v Values) -> Option<&'v Values> {
        v.inner(self.key.name)
    }

    /// The field of the values of its table.
    ///
    /// # Errors
    /// What is wrong with it; nothing, if the value has a problem that is reported already.
    pub fn read(&self, v: &Values, c: &Context<'_>) -> Made<T> {
        let value = v.get(self.key.name).map(|filled| &filled.value);
        self.reader.read(value, c).map_err(|faults| faults.within(self.key.name))
    }
}

impl<T> Field<Option<T>> {
    /// The same, without which there is no run.
    pub const fn for_run(self) -> Field<Option<T>> {
        self.left_out(Presence::Run)
    }
}

impl Field<f64> {
    /// The same with a number where it is left out.
    pub const fn or(self, number: f64) -> Field<f64> {
        self.left_out(Presence::Number(number))
    }
}

impl Field<bool> {
    /// The same, true where it is left out.
    pub const fn or_true(self) -> Field<bool> {
        self.left_out(Presence::Boolean(true))
    }

    /// The same, false where it is left out.
    pub const fn or_false(self) -> Field<bool> {
        self.left_out(Presence::Boolean(false))
    }
}

impl Field<usize> {
    /// The same with a count where it is left out.
    pub const fn or_count(self, count: usize) -> Field<usize> {
        self.left_out(Presence::Integer(count as i64))
    }
}

impl Field<i64> {
    /// The same with an integer where it is left out.
    pub const fn or_integer(self, integer: i64) -> Field<i64> {
        self.left_out(Presence::Integer(integer))
    }
}

/// What a value holds.
pub trait Sort {
    /// What happens where an optional key is left out.
    const NONE: Presence = Presence::Optional;
}
impl Sort for f64 {}
impl Sort for i64 {}
impl Sort for bool {}
impl Sort for str {}
impl Sort for [String] {}
impl Sort for Place {}
impl Sort for [f64] {
    const NONE: Presence = Presence::Empty;
}

/// A field of a value that holds an `S`.
pub trait Takes<S: ?Sized>: Sized {
    /// What happens where the key is left out.
    const PRESENCE: Presence = Presence::Required;

    /// The field.
    ///
    /// # Errors
    /// What is wrong, at paths within the key; nothing, if there is no value, for it has a problem that is reported already.
    fn take(value: Option<&Value>, c: &Context<'_>) -> Made<Self>;
}

/// An empty list is one that is left out.
impl<S: Sort + ?Sized, T: Takes<S>> Takes<S> for Option<T> {
    const PRESENCE: Presence = S::NONE;

    fn take(value: Option<&Value>, c: &Context<'_>) -> Made<Option<T>> {
        match value {
            None => Ok(None),
            Some(Value::Numbers(list)) if list.is_empty() => Ok(None),
            Some(Value::Texts(list)) if list.is_empty() => Ok(None),
            value => T::take(value, c).map(Some),
        }
    }
}

/// Fields that are what the value holds.
macro_rules! taken {
    ($($sort:ty => $type:ty: $pattern:pat => $value:expr;)*) => {
        $(impl Takes<$sort> for $type {
            fn take(value: Option<&Value>, _: &Context<'_>) -> Made<$type> {
                match value {
                    Some($pattern) => Ok($value),
                    _ => Err(Faults::default()),
                }
            }
        })*
    };
}

taken! {
    f64 => f64: Value::Number(value) => *value;
    i64 => i64: Value::Integer(value) => *value;
    i64 => usize: Value::Integer(value) => usize::try_from(*value).at("")?;
    bool => bool: Value::Boolean(value) => *value;
    str => String: Value::Text(value) => value.clone();
    [String] => Vec<String>: Value::Texts(values) => values.clone();
    [f64] => Vec<f64>: Value::Numbers(values) => values.clone();
}

impl<const N: usize> Takes<[f64]> for [f64; N] {
    fn take(value: Option<&Value>, c: &Context<'_>) -> Made<[f64; N]> {
        let list: Vec<f64> = Takes::take(value, c)?;
        let count = list.len();
        list.try_into().map_err(|_| Fault::new("", format!("takes {N} numbers, not {count}")).into())
    }
}

/// Components along x, y and z, or zeros where the key is left out; z is 0 where two are given.
impl Takes<[f64]> for Vec3 {
    const PRESENCE: Presence = Presence::Empty;

    fn take(value: Option<&Value>, c: &Context<'_>) -> Made<Vec3> {
        let list: Vec<f64> = Takes::take(value, c)?;
        match list[..] {
            [] => Ok(Vec3::ZERO),
            [x, y] => Ok(Vec3([x, y, 0.0])),
            [x, y, z] => Ok(Vec3([x, y, z])),
            _ => {
                let count = list.len();
                let message =
                    format!("has 2 components in the plane of x and y, or 3 in space, and not {count}");
                Err(Fault::new("", message).into())
            }
        }
    }
}

/// A moment: one number is about z.
#[derive(Clone, Copy)]
pub struct Moment(pub Vec3);

impl Takes<[f64]> for Moment {
    fn take(value: Option<&Value>, c: &Context<'_>) -> Made<Moment> {
        let list: Vec<f64> = Takes::take(value, c)?;
        match list[..] {
            [z] => Ok(Moment(Vec3([0.0, 0.0, z]))),
            [x, y, z] => Ok(Moment(Vec3([x, y, z]))),
            _ => {
                let message = format!("is one number, about z, or has 3 components, and not {}", list.len());
                Err(Fault::new("", message).into())
            }
        }
    }
}

impl Takes<Place> for Place {
    fn take(value: Option<&Value>, c: &Context<'_>) -> Made<Place> {
        let written: String = Takes::<str>::take(value, c)?;
        c.parts()?.find(&written).map_err(Faults::from)
    }
}

/// The station of a beam: its number and the arc length \[m\].
impl Takes<Place> for (usize, f64) {
    fn take(value: Option<&Value>, c: &Context<'_>) -> Made<(usize, f64)> {
        let what = match Place::take(value, c)? {
            Place::Station { beam, s } => return Ok((beam, s)),
            Place::Ground => "the ground",
            Place::Body(_) => "a body",
            Place::Beam(_) => "a whole beam",
        };
        let fault = Fault::new("", format!("is {what}, and not a station of a beam"));
        Err(fault.help("write for example `on = \"tip\"` or `on = \"2 m\"`").into())
    }
}

/// A file that a case names.
pub struct File {
    /// Its name, as it is written.
    pub name: String,
    /// What it contains.
    pub bytes: Arc<[u8]>,
}

impl Takes<str> for File {
    fn take(value: Option<&Value>, c: &Context<'_>) -> Made<File> {
        let name: String = Takes::<str>::take(value, c)?;
        let bytes = c.files.bytes(&name).at("")?;
        Ok(File { name, bytes })
    }
}

/// Makes fields of values that hold an `S`.
struct Held<S: ?Sized>(std::marker::PhantomData<S>);

impl<S: ?Sized, T: Takes<S>> Reader<T> for Held<S> {
    fn read(&'static self, value: Option<&Value>, c: &Context<'_>) -> Made<T> {
        T::take(value, c)
    }
}

const fn held<S: ?Sized + 'static, T: Takes<S>>(takes: Type) -> Field<T> {
    Field::new(takes, T::PRESENCE, &Held::<S>(std::marker::PhantomData))
}

/// A number with a dimension.
pub const fn quantity<T: Takes<f64>>(measure: &'static Measure, bound: Bound) -> Field<T> {
    held(Type::Quantity(measure, bound))
}

/// A list of numbers with a dimension.
pub const fn quantities<T: Takes<[f64]>>(measure: &'static Measure, bound: Bound) -> Field<T> {
    held(Type::Quantities(measure, bound))
}

/// Components along axes, any finite numbers with a dimension.
pub const fn vector<T: Takes<[f64]>>(measure: &'static Measure) -> Field<T> {
    quantities(measure, Bound::Any)
}

/// A number with a dimension, or a list of such numbers.
pub const fn moment(measure: &'static Measure) -> Field<Option<Moment>> {
    held::<[f64], _>(Type::Moment(measure))
}

/// A number without dimension.
pub const fn number<T: Takes<f64>>(bound: Bound) -> Field<T> {
    held(Type::Number(bound))
}

/// An integer of a range, ends included.
pub const fn integer<T: Takes<i64>>(low: i64, high: i64) -> Field<T> {
    held(Type::Integer(low, high))
}

/// `true` or `false`.
pub const fn boolean<T: Takes<bool>>() -> Field<T> {
    held(Type::Boolean)
}

/// Any text.
pub const fn text<T: Takes<str>>() -> Field<T> {
    held(Type::Text)
}

/// A path, relative to the folder of the case.
pub const fn path<T: Takes<str>>() -> Field<T> {
    held(Type::Path)
}

/// A list of texts.
pub const fn texts<T: Takes<[String]>>() -> Field<T> {
    held(Type::Texts)
}

/// A place.
pub const fn place<T: Takes<Place>>() -> Field<T> {
    held(Type::Place)
}

/// A place, or a list of places.
pub const fn places<T: Takes<[String]>>() -> Field<T> {
    held(Type::Places)
}

/// A field of a choice that makes a `T`.
pub trait Chosen<T>: Sized {
    /// What happens where the key is left out.
    const PRESENCE: Presence;

    /// The field.
    ///
    /// # Errors
    /// What the maker refuses, at paths within the key; nothing, if the value has a problem that is reported already.
    fn choose(choice: &'static Choice<T>, value: Option<&Value>, c: &Context<'_>) -> Made<Self>;
}

impl<T> Chosen<T> for T {
    const PRESENCE: Presence = Presence::Required;

    fn choose(choice: &'static Choice<T>, value: Option<&Value>, c: &Context<'_>) -> Made<T> {
        value.map_or_else(|| Err(Faults::default()), |value| choice.make(value, c))
    }
}

impl<T> Chosen<T> for Option<T> {
    const PRESENCE: Presence = Presence::Optional;

    fn choose(choice: &'static Choice<T>, value: Option<&Value>, c: &Context<'_>) -> Made<Option<T>> {
        value.map(|value| choice.make(value, c)).transpose()
    }
}

/// What is chosen, by its name too.
pub struct Named<T> {
    /// The name.
    pub name: &'static str,
    /// What is made of it.
    pub made: T,
}

impl<T> Chosen<T> for Named<T> {
    const PRESENCE: Presence = Presence::Required;

    fn choose(choice: &'static Choice<T>, value: Option<&Value>, c: &Context<'_>) -> Made<Named<T>> {
        let made = T::choose(choice, value, c)?;
        Ok(Named { name: value.map_or("", |value| choice.named(value)), made })
    }
}

/// What is made when more is known of the case.
pub struct Later<T: 'static> {
    choice: &'static Choice<T>,
    value: Option<Value>,
}

impl<T> Chosen<T> for Later<T> {
    const PRESENCE: Presence = Presence::Optional;

    fn choose(choice: &'static Choice<T>, value: Option<&Value>, _: &Context<'_>) -> Made<Later<T>> {
        Ok(Later { choice, value: value.cloned() })
    }
}

impl<T> Later<T> {
    /// Whether the key has a value.
    pub fn is_given(&self) -> bool {
        self.value.is_some()
    }

    /// The name of the kind that is chosen.
    pub fn chosen(&self) -> Option<&str> {
        match self.value.as_ref()? {
            Value::Kind(entry, _) => Some(entry.name),
            Value::Text(name) => Some(name),
            _ => None,
        }
    }

    /// What is chosen, if it is not left out.
    ///
    /// # Errors
    /// What the maker refuses, at paths within `key`.
    pub fn make(&self, key: &str, c: &Context<'_>) -> Made<Option<T>> {
        Option::choose(self.choice, self.value.as_ref(), c).map_err(|faults| faults.within(key))
    }
}

impl<T, F: Chosen<T>> Reader<F> for Choice<T> {
    fn read(&'static self, value: Option<&Value>, c: &Context<'_>) -> Made<F> {
        F::choose(self, value, c)
    }
}

/// One of some names.
pub const fn choice<T, F: Chosen<T>>(of: &'static Choice<T>) -> Field<F> {
    Field::new(Type::Choice(of), F::PRESENCE, of)
}

/// A table whose `kind` decides which keys it has.
pub const fn kind<T, F: Chosen<T>>(of: &'static Choice<T>) -> Field<F> {
    Field::new(Type::Kind(of), F::PRESENCE, of)
}

/// A field of a table with keys.
pub trait Nested: Sized {
    /// The keys.
    const KEYS: &'static [Key];
    /// What happens where the table is left out.
    const PRESENCE: Presence;

    /// The field.
    ///
    /// # Errors
    /// What is wrong, at paths within the key.
    fn nested(value: Option<&Value>, c: &Context<'_>) -> Made<Self>;
}

impl<K: Keys> Nested for K {
    const KEYS: &'static [Key] = K::KEYS;
    const PRESENCE: Presence = Presence::Empty;

    fn nested(value: Option<&Value>, c: &Context<'_>) -> Made<K> {
        if let Some(Value::Table(values)) = value { K::read(values, c) } else { Err(Faults::default()) }
    }
}

impl<K: Keys> Nested for Option<K> {
    const KEYS: &'static [Key] = K::KEYS;
    const PRESENCE: Presence = Presence::Optional;

    fn nested(value: Option<&Value>, c: &Context<'_>) -> Made<Option<K>> {
        value.map(|_| K::nested(value, c)).transpose()
    }
}

/// Makes fields of tables.
struct InTable;

impl<T: Nested> Reader<T> for InTable {
    fn read(&'static self, value: Option<&Value>, c: &Context<'_>) -> Made<T> {
        T::nested(value, c)
    }
}

/// A table with the keys of a type.
pub const fn table<T: Nested>() -> Field<T> {
    Field::new(Type::Table(T::KEYS), T::PRESENCE, &InTable)
}

/// The name of a field as that of a key.
pub(crate) const fn kebab<const N: usize>(name: &str) -> [u8; N] {
    let (from, mut to) = (name.as_bytes(), [b'-'; N]);
    let mut i = 0;
    while i < N {
        if from[i] != b'_' {
            to[i] = from[i];
        }
        i += 1;
    }
    to
}

/// Declares types whose fields are the keys of tables, as [the module](self) says.
macro_rules! keys {
    ($($(#[$meta:meta])* $vis:vis struct $name:ident {
        $($(#[doc = $doc:literal])* $field:ident: $type:ty = $key:expr;)*
    })*) => {$(
        $(#[$meta])*
        $vis struct $name {
            $(pub(crate) $field: $type,)*
        }

        #[allow(non_upper_case_globals)]
        impl $name {
            $(pub(crate) const $field: $crate::keys::Field<$type> = {
                const OF_FIELD: [u8; stringify!($field).len()] = $crate::keys::kebab(stringify!($field));
                let name = match std::str::from_utf8(&OF_FIELD) {
                    Ok(name) => name,
                    Err(_) => stringify!($field),
                };
                $key.called(name, concat!("", $($doc),*))
            };)*
        }

        impl $crate::kind::Keys for $name {
            const KEYS: &'static [$crate::declaration::Key] = &[$(Self::$field.key),*];

            fn read(v: &$crate::values::Values, c: &$crate::kind::Context<'_>) -> $crate::fault::Made<Self> {
                let mut found = $crate::fault::Found::default();
                $(let $field = found.part(Self::$field.read(v, c));)*
                match ($($field,)*) {
                    ($(Some($field),)*) if v.sound => Ok(Self { $($field),* }),
                    _ => Err(found.0),
                }
            }
        }
    )*};
}
pub(crate) use keys;
