//! A checkpoint or part of a render of any bytes is read, or refused; what is read can be merged, estimated and gone on from.
#![no_main]

mod folder;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let path = folder::write("part.exr", bytes);
    if let Ok((rendered, _)) = luminaire::part::read(&path) {
        assert_eq!(rendered.film.pixels(), rendered.film.width as usize * rendered.film.height as usize);
        rendered.film.error();
        rendered.film.to_linear();
    }
    let _ = luminaire::part::merge(&[path.clone(), path]);
});
