//! Texels written out as the bytes of a map, on all threads.

use std::ops::Range;

use crate::parallel::for_each_piece;
use crate::raster::Grid;

/// Texels that are written by one thread after the other.
const PIECE: usize = 1 << 14;

/// The bytes of so many texels, N each; `write` puts down those of some in a row.
pub(super) fn packed<const N: usize>(
    count: usize,
    write: impl Fn(Range<usize>, &mut [[u8; N]]) + Sync,
) -> Vec<u8> {
    let mut bytes = vec![0; N * count];
    for_each_piece(&mut bytes, N * PIECE, &|i, piece| {
        let (texels, _) = piece.as_chunks_mut();
        write(i * PIECE..i * PIECE + texels.len(), texels);
    });
    bytes
}

/// How many texels all of some planes have: none where one of them was not painted.
pub(super) fn in_all<T>(planes: &[&[T]]) -> usize {
    planes.iter().map(|plane| plane.len()).min().unwrap_or(0)
}

/// The bytes of a plane, N of each texel.
pub(super) fn of_plane<T: Sync, const N: usize>(
    plane: &Grid<T>,
    channels: impl Fn(&T) -> [u8; N] + Sync,
) -> Vec<u8> {
    let plane = plane.values();
    packed(plane.len(), |texels, bytes| {
        for (bytes, texel) in bytes.iter_mut().zip(&plane[texels]) {
            *bytes = channels(texel);
        }
    })
}

/// The bytes of so many texels of N words each, high bytes first.
pub(super) fn words<const N: usize>(
    count: usize,
    texel: impl Fn(usize) -> [u16; N] + Sync,
) -> Vec<u8> {
    let mut bytes = vec![0; 2 * N * count];
    for_each_piece(&mut bytes, 2 * N * PIECE, &|i, piece| {
        for (at, bytes) in piece.chunks_exact_mut(2 * N).enumerate() {
            let (pairs, _) = bytes.as_chunks_mut();
            for (pair, word) in pairs.iter_mut().zip(texel(i * PIECE + at)) {
                *pair = word.to_be_bytes();
            }
        }
    });
    bytes
}

/// The bytes of a plane of which each texel has N words.
pub(super) fn words_of<T: Copy + Sync, const N: usize>(
    plane: &Grid<T>,
    channels: impl Fn(T) -> [u16; N] + Sync,
) -> Vec<u8> {
    let plane = plane.values();
    words(plane.len(), |i| channels(plane[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_texel_is_written_once_and_in_order() {
        let count = 2 * PIECE + 5;
        let value = |i: usize| (i * 40_503) as u16;
        let plane = Grid::from_values(count, 1, (0..count).map(value).collect());
        let expected: Vec<u8> = (0..count).flat_map(|i| value(i).to_be_bytes()).collect();
        assert_eq!(of_plane(&plane, |value| value.to_be_bytes()), expected);
        assert_eq!(words(count, |i| [value(i)]), expected);
        let both = words(count, |i| [value(i), i as u16]);
        let pairs = both.chunks_exact(4).zip(expected.chunks_exact(2));
        assert!(pairs.enumerate().all(|(i, (both, one))| {
            both[..2] == *one && both[2..] == (i as u16).to_be_bytes()
        }));
    }
}
