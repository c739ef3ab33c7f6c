//! The PNGs: their chunks by a reader of our own, their pixels by an independent decoder.

use super::{SIZE, SmallLeaf, bytes_of};

/// Kind and content of every chunk, each CRC checked; nothing of the encoder's library.
fn chunks(png: &[u8]) -> Vec<(String, &[u8])> {
    assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
    let mut rest = &png[8..];
    let mut chunks = Vec::new();
    while !rest.is_empty() {
        let length = u32::from_be_bytes(rest[..4].try_into().unwrap()) as usize;
        let crc = u32::from_be_bytes(rest[8 + length..12 + length].try_into().unwrap());
        assert_eq!(crc32(&rest[4..8 + length]), crc);
        chunks.push((String::from_utf8(rest[4..8].to_vec()).unwrap(), &rest[8..8 + length]));
        rest = &rest[12 + length..];
    }
    chunks
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| {
            if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 }
        })
    })
}

#[test]
fn pngs_say_what_they_are() {
    let leaf = SmallLeaf::new("oak");
    let files = leaf.encoded();
    // Bit depth and colour type as the format numbers them: 0 grey, 2 RGB, 4 grey + alpha, 6 RGBA.
    let kinds = [
        ("BaseColor", 8, 6),
        ("Opacity", 8, 4),
        ("Height", 16, 0),
        ("Normal", 8, 2),
        ("Roughness", 8, 0),
        ("AmbientOcclusion", 8, 0),
        ("ORM", 8, 6),
        ("Translucency", 8, 2),
        ("Thickness", 16, 0),
        ("VeinMask", 8, 0),
        ("VeinOrder", 8, 0),
        ("Bump", 8, 2),
    ];
    let per_metre = (leaf.textures.frame.pixels_per_mm(SIZE) * 1000.0).round() as u32;
    for folder in ["", "back/"] {
        for (suffix, depth, colour) in kinds {
            let chunks = chunks(bytes_of(&files, &format!("{folder}oak_{suffix}.png")));
            let content = |kind: &str| {
                chunks.iter().find(|(name, _)| name == kind).map(|(_, content)| *content)
            };
            assert_eq!(chunks[0].0, "IHDR");
            let header = chunks[0].1;
            assert_eq!(header[..8], [0, 0, 0, SIZE as u8, 0, 0, 0, SIZE as u8]);
            assert_eq!(header[8..], [depth, colour, 0, 0, 0], "{suffix}");
            let coloured = ["BaseColor", "Translucency"].contains(&suffix);
            assert_eq!(content("sRGB").is_some(), coloured, "{suffix}");
            for bending in ["iCCP", "tIME"] {
                assert_eq!(content(bending), None, "{suffix}");
            }
            if !coloured {
                assert_eq!((content("gAMA"), content("cHRM")), (None, None), "{suffix}");
            }
            let size = [&per_metre.to_be_bytes()[..], &per_metre.to_be_bytes(), &[1]].concat();
            assert_eq!(content("pHYs"), Some(&size[..]), "{suffix}");
            let software = format!("Software\0venation {}", env!("CARGO_PKG_VERSION"));
            assert_eq!(content("tEXt"), Some(software.as_bytes()));
            // Keyword, no compression, no language, the text as UTF-8.
            let seed = b"Seed\0\0\0\0\x007";
            assert!(chunks.iter().any(|(kind, text)| kind == "iTXt" && text == seed), "{suffix}");
        }
    }
    let front = chunks(bytes_of(&files, "oak_BaseColor.png"));
    let settings = "Settings\0\0\0\0\0seed = 7\nname = \"prüf\"\n".as_bytes();
    assert!(front.iter().any(|(kind, text)| kind == "iTXt" && *text == settings));
}

#[test]
fn pixels_read_back_as_they_were() {
    let leaf = SmallLeaf::new("oak");
    let files = leaf.encoded();
    for (folder, maps) in [("", &leaf.textures.front), ("back/", &leaf.textures.back)] {
        let decoded = |suffix: &str| {
            image::load_from_memory(bytes_of(&files, &format!("{folder}oak_{suffix}.png"))).unwrap()
        };
        let colours = maps.base_colour.values();
        assert_eq!(decoded("BaseColor").as_rgba8().unwrap().as_raw(), colours.as_flattened());
        let opacity: Vec<u8> = colours.iter().flat_map(|&[.., a]| [a, a]).collect();
        assert_eq!(*decoded("Opacity").as_luma_alpha8().unwrap().as_raw(), opacity);
        assert_eq!(decoded("Height").as_luma16().unwrap().as_raw(), maps.height.values());
        let normals = maps.normal.values().as_flattened();
        assert_eq!(decoded("Normal").as_rgb8().unwrap().as_raw(), normals);
        let packed: Vec<u8> = (0..SIZE * SIZE)
            .flat_map(|i| {
                let of = |plane: &venation::raster::Grid<u8>| plane.values()[i];
                [of(&maps.occlusion), of(&maps.roughness), 0, of(&maps.transmission)]
            })
            .collect();
        assert_eq!(*decoded("ORM").as_rgba8().unwrap().as_raw(), packed);
        assert_eq!(decoded("Thickness").as_luma16().unwrap().as_raw(), maps.thickness.values());
        assert_eq!(decoded("VeinOrder").as_luma8().unwrap().as_raw(), maps.vein_order.values());
        let bump: Vec<u8> = maps.bump.values().iter().flat_map(|&h| [h, 0, 0]).collect();
        assert_eq!(*decoded("Bump").as_rgb8().unwrap().as_raw(), bump);
    }
}
