//! Choices that users name.

use super::Error;

/// Gives the variants of a choice their names, as users type them and as reports have them: `ALL`, `Display`, `FromStr` and
/// `Serialize`. `$what` is what messages call the choice.
macro_rules! named {
    ($choice:ident, $what:literal, [$($variant:ident = $name:literal),+ $(,)?]) => {
        impl $choice {
            /// All of them.
            pub const ALL: [Self; [$($name),+].len()] = [$(Self::$variant),+];
        }

        impl std::fmt::Display for $choice {
            fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.pad(match self {
                    $(Self::$variant => $name),+
                })
            }
        }

        impl std::str::FromStr for $choice {
            type Err = $crate::error::Error;

            /// # Errors
            /// [`Error::Parse`](crate::error::Error::Parse) of any other name.
            fn from_str(name: &str) -> std::result::Result<Self, Self::Err> {
                let found = Self::ALL.into_iter().find(|choice| choice.to_string() == name);
                found.ok_or_else(|| $crate::error::unknown($what, name, &[$($name),+]))
            }
        }

        impl serde::Serialize for $choice {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
                serializer.collect_str(self)
            }
        }
    };
}

pub(crate) use named;

/// What a name is answered with that no choice has.
pub(crate) fn unknown(what: &str, name: &str, names: &[&str]) -> Error {
    let (last, others) = names.split_last().expect("a choice has names");
    Error::parse(format!("{what} {name}"), format!("no such {what}"), format!("choose {} or {last}", others.join(", ")))
}

#[cfg(test)]
mod tests {
    use crate::diagram::Kind;

    #[test]
    fn names_are_read_as_written_and_others_refused() {
        for kind in Kind::ALL {
            assert_eq!(kind.to_string().parse::<Kind>().unwrap(), kind);
            assert_eq!(serde_json::to_value(kind).unwrap(), kind.to_string(), "as in reports");
        }
        assert_eq!(format!("{:>8}", Kind::DuWang), " du-wang");
        let error = "Du-Wang".parse::<Kind>().unwrap_err();
        assert_eq!(error.to_string(), "Voronoi diagram Du-Wang: no such Voronoi diagram");
        assert_eq!(error.help(), "choose riemannian, du-wang or labelle-shewchuk");
    }
}
