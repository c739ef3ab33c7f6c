//! Enums of plain words, as files and the command line give them.

/// Declares an enum of plain words: serde in kebab-case, [`Choice`], `Display` and `FromStr`.
macro_rules! words {
    (
        $(#[$attribute:meta])*
        pub enum $Name:ident { $( $(#[doc = $doc:literal])+ $Variant:ident = $word:literal ),* $(,)? }
    ) => {
        $(#[$attribute])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        pub enum $Name { $( $(#[doc = $doc])+ #[serde(rename = $word)] $Variant, )* }

        impl $Name {
            /// Every variant, in order.
            pub const ALL: &'static [Self] = &[$( Self::$Variant ),*];

            /// The word for it in files and on the command line.
            #[must_use]
            pub const fn word(self) -> &'static str {
                match self { $( Self::$Variant => $word ),* }
            }
        }

        impl $crate::parameter::Choice for $Name {
            const WORDS: &'static [&'static str] = &[$( $word ),*];
        }

        impl std::str::FromStr for $Name {
            type Err = $crate::parameter::UnknownWord;

            fn from_str(text: &str) -> Result<Self, Self::Err> {
                Self::ALL.iter().copied().find(|variant| variant.word() == text).ok_or_else(|| {
                    $crate::parameter::UnknownWord {
                        word: text.to_owned(),
                        words: <Self as $crate::parameter::Choice>::WORDS,
                    }
                })
            }
        }

        impl std::fmt::Display for $Name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.word())
            }
        }
    };
}

pub(crate) use words;
