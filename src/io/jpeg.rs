//! JPEG files that are whole.
//!
//! Decoders paint what is missing of a file that was cut short grey and say nothing of it; here such a
//! file is refused.

use std::fs::File;
use std::io::Read;

/// JPEG files may have this many bytes, since they are read whole.
const MOST_BYTES: u64 = 256 << 20;

/// The markers that begin a scan and end a picture (ITU-T T.81, table B.1). In a scan's data neither can
/// stand: there 0xff is followed by 0.
const SCAN: [u8; 2] = [0xff, 0xda];
const END: [u8; 2] = [0xff, 0xd9];

/// What is wrong with a file.
#[derive(Debug)]
pub(super) enum Problem {
    /// It cannot be read.
    Read(std::io::Error),
    /// What it holds.
    Content(String),
}

/// The bytes of a file.
pub(super) fn read(mut file: &File) -> Result<Vec<u8>, Problem> {
    let length = file.metadata().map_err(Problem::Read)?.len();
    if length > MOST_BYTES {
        return Err(Problem::Content(format!(
            "has {length} bytes; a JPEG picture may have {MOST_BYTES}: reduce it"
        )));
    }
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).map_err(Problem::Read)?;
    if is_cut_short(&bytes) {
        return Err(Problem::Content("is not a sound JPEG picture: it is cut short".into()));
    }
    Ok(bytes)
}

/// Whether the last scan has no end. The last: a small picture of its own may come before, in the header.
fn is_cut_short(bytes: &[u8]) -> bool {
    let last = |marker: [u8; 2]| bytes.windows(2).rposition(|pair| pair == marker);
    last(SCAN).is_some_and(|scan| last(END).is_none_or(|end| end < scan))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_ends_after_its_last_scan() {
        let preview = [SCAN, [1, 2], END].concat();
        let whole = [&preview[..], &SCAN, &[0xff, 0, 7], &END, b"more"].concat();
        assert!(!is_cut_short(&whole));
        assert!(is_cut_short(&whole[..whole.len() - 5]));
        // Nothing to see yet: the decoder knows what is wrong.
        assert!(!is_cut_short(&[0xff, 0xd8, 0xff]));
    }
}
