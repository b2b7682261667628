//! The state of a simulation as bytes, and back: a simulation that is restored goes on bit for bit.
//!
//! Numbers are little-endian; a list is its length and its items one after the other, so that an
//! array of numbers is just that; a structure is its fields in order. What is not written is
//! either made anew from what is (the numbering of cells and nodes, the mesh's geometry), or is
//! written by every step before it is read. Structures are taken apart and put together by name of
//! every field, so that none can be forgotten here. Bytes are handed on in pieces as they are made:
//! a large state is never in memory twice.

mod out;
mod simulation;
mod types;
mod values;

pub use out::{Out, Part, Section, to_bytes};
pub use simulation::instant;
pub(crate) use values::{list_size, save_list};

/// Something that can be written as bytes and read back, equal bit for bit.
pub trait Saved: Sized {
    /// Number of bytes that [`Saved::save`] will write.
    fn size(&self) -> usize;

    /// Writes it.
    fn save(&self, out: &mut Out);

    /// Writes several one after the other; numbers have a faster way.
    fn save_all(items: &[Self], out: &mut Out) {
        items.iter().for_each(|item| item.save(out));
    }

    /// Takes it from the front.
    ///
    /// # Errors
    ///
    /// If the bytes are not such a thing.
    fn load(from: &mut Bytes) -> Result<Self, Broken>;
}

/// Bytes are not what they should be.
#[derive(Clone, Debug, thiserror::Error, PartialEq)]
#[error("{what} cannot be read")]
pub struct Broken {
    pub what: String,
}

impl Broken {
    pub fn new(what: impl Into<String>) -> Broken {
        Broken { what: what.into() }
    }
}

/// Bytes that are read from the front.
#[derive(Clone, Debug)]
pub struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    pub fn new(bytes: &'a [u8]) -> Bytes<'a> {
        Bytes(bytes)
    }

    /// The next `count` bytes.
    ///
    /// # Errors
    ///
    /// If there are not so many.
    pub fn take(&mut self, count: usize) -> Result<&'a [u8], Broken> {
        let (taken, rest) = (self.0.split_at_checked(count))
            .ok_or_else(|| Broken::new("a value that is cut off"))?;
        self.0 = rest;
        Ok(taken)
    }

    /// Number of bytes that are left.
    pub fn left(&self) -> usize {
        self.0.len()
    }
}

/// All that `bytes` hold, as one thing.
///
/// # Errors
///
/// If they do not, or hold more.
pub fn load<T: Saved>(bytes: &[u8]) -> Result<T, Broken> {
    let mut bytes = Bytes::new(bytes);
    let loaded = T::load(&mut bytes)?;
    match bytes.left() {
        0 => Ok(loaded),
        _ => Err(Broken::new("what follows")),
    }
}

/// Makes a structure [`Saved`], field by field.
#[macro_export]
macro_rules! saved {
    ($name:ident { $($field:ident),* $(,)? }) => {
        impl $crate::saved::Saved for $name {
            #[inline]
            fn size(&self) -> usize {
                let $name { $($field),* } = self;
                0 $(+ $crate::saved::Saved::size($field))*
            }

            fn save(&self, out: &mut $crate::saved::Out) {
                let $name { $($field),* } = self;
                $($crate::saved::Saved::save($field, out);)*
            }

            fn load(from: &mut $crate::saved::Bytes) -> Result<Self, $crate::saved::Broken> {
                Ok($name { $($field: $crate::saved::Saved::load(from)?),* })
            }
        }
    };
}

/// Makes an enumeration [`Saved`]: a byte that says which, and its fields. Numbers are never given
/// twice, also not to what there is no more.
#[macro_export]
macro_rules! saved_enum {
    ($name:ident { $($number:literal => $variant:ident $( { $($field:ident),* } )? $( ( $($item:ident),* ) )?),* $(,)? }) => {
        impl $crate::saved::Saved for $name {
            fn size(&self) -> usize {
                match self {
                    $($name::$variant $( { $($field),* } )? $( ( $($item),* ) )? => {
                        1 $($(+ $crate::saved::Saved::size($field))*)?
                            $($(+ $crate::saved::Saved::size($item))*)?
                    })*
                }
            }

            fn save(&self, out: &mut $crate::saved::Out) {
                match self {
                    $($name::$variant $( { $($field),* } )? $( ( $($item),* ) )? => {
                        out.put(&[$number]);
                        $($($crate::saved::Saved::save($field, out);)*)?
                        $($($crate::saved::Saved::save($item, out);)*)?
                    })*
                }
            }

            fn load(from: &mut $crate::saved::Bytes) -> Result<Self, $crate::saved::Broken> {
                Ok(match from.take(1)?[0] {
                    $($number => {
                        $($(let $field = $crate::saved::Saved::load(from)?;)*)?
                        $($(let $item = $crate::saved::Saved::load(from)?;)*)?
                        $name::$variant $( { $($field),* } )? $( ( $($item),* ) )?
                    })*
                    _ => return Err($crate::saved::Broken::new(stringify!($name))),
                })
            }
        }
    };
}
