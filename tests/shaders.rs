//! The shipped SPIR-V is what the GLSL gives, and its structures are those of the host. No GPU needed.

use luminaire::gpu::{SHADERS, layout};
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::{Decoration, Op};
use std::collections::HashMap;
use std::io::Write;
use std::path::Path;
use std::process::Command;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Same compiler: same bytes. Another compiler: the sources still compile, and have not changed since the SPIR-V was made.
#[test]
fn shipped_spirv_is_what_the_sources_give() {
    let folder = tempfile::tempdir().expect("a folder");
    let shipped = Path::new(ROOT).join("shaders/spirv");
    let output =
        match Command::new("bash").arg("scripts/build-shaders.sh").arg(folder.path()).current_dir(ROOT).output() {
            Ok(output) if output.status.success() => output,
            Ok(output) if !String::from_utf8_lossy(&output.stderr).contains("glslc is missing") => {
                panic!("{}", String::from_utf8_lossy(&output.stderr))
            }
            _ => {
                assert!(std::env::var_os("LUMINAIRE_REQUIRE_GPU").is_none(), "glslc is missing");
                let _ = writeln!(
                    std::io::stderr(),
                    "SKIP: glslc is missing; the shipped SPIR-V was not compared with the sources"
                );
                return;
            }
        };
    assert!(output.status.success());
    let provenance = |folder: &Path| {
        let text = std::fs::read_to_string(folder.join("provenance.txt")).expect("provenance.txt");
        let mut lines = text.lines().map(String::from);
        (lines.next().expect("the compiler"), lines.next().expect("the hash"))
    };
    let (new, old) = (provenance(folder.path()), provenance(&shipped));
    assert_eq!(new.1, old.1, "the sources have changed: run `make shaders` and commit shaders/spirv");
    if new.0 != old.0 {
        let _ = writeln!(
            std::io::stderr(),
            "SKIP: this is {}, the SPIR-V was made by {}: bytes not compared",
            new.0,
            old.0
        );
        return;
    }
    for shader in SHADERS {
        let file = format!("{}.spv", shader.name);
        let rebuilt = std::fs::read(folder.path().join(&file)).expect("rebuilt");
        assert!(rebuilt == shader.spirv, "{file} is not what the sources give: run `make shaders`");
    }
}

/// Byte offset of every named member of every structure in a module, and the structures' names.
fn structures(spirv: &[u8]) -> HashMap<String, Vec<(String, u32)>> {
    let module = rspirv::dr::load_bytes(spirv).expect("valid SPIR-V");
    let id = |i: &Instruction| match i.operands[0] {
        Operand::IdRef(id) => id,
        _ => unreachable!("names and decorations begin with an id"),
    };
    let mut names = HashMap::new();
    let mut members: HashMap<(u32, u32), String> = HashMap::new();
    for i in &module.debug_names {
        match (i.class.opcode, &i.operands[1..]) {
            (Op::Name, [Operand::LiteralString(name)]) => drop(names.insert(id(i), name.clone())),
            (Op::MemberName, [Operand::LiteralBit32(member), Operand::LiteralString(name)]) => {
                members.insert((id(i), *member), name.clone());
            }
            _ => {}
        }
    }
    let mut found: HashMap<String, Vec<(String, u32)>> = HashMap::new();
    for i in &module.annotations {
        if let (
            Op::MemberDecorate,
            [
                Operand::IdRef(structure),
                Operand::LiteralBit32(member),
                Operand::Decoration(Decoration::Offset),
                Operand::LiteralBit32(offset),
            ],
        ) = (i.class.opcode, i.operands.as_slice())
        {
            found.entry(names[structure].clone()).or_default().push((members[&(*structure, *member)].clone(), *offset));
        }
    }
    found
}

/// Every member of every shared structure has the same name, order and offset on both sides, in every shader that uses it.
#[test]
fn structures_are_laid_out_alike() {
    let mut seen = Vec::new();
    for shader in SHADERS {
        let found = structures(shader.spirv);
        for (name, size, members) in layout::STRUCTS {
            let Some(in_shader) = found.get(*name) else { continue };
            seen.push(*name);
            let expected: Vec<(String, u32)> = members
                .iter()
                .filter(|(member, _)| in_shader.iter().any(|(m, _)| m == member) || !member.starts_with("padding"))
                .map(|(member, offset)| (member.to_string(), *offset as u32))
                .collect();
            assert_eq!(in_shader, &expected, "{name} in {}", shader.name);
            assert_eq!(size % 4, 0);
        }
    }
    for (name, ..) in layout::STRUCTS {
        assert!(seen.contains(name), "no shader has {name}");
    }
}

/// Names of a module by their ids, and the numbers of one decoration.
fn names_and_decorations(
    module: &rspirv::dr::Module,
    decoration: Decoration,
) -> (HashMap<u32, String>, HashMap<u32, u32>) {
    let (mut names, mut numbers) = (HashMap::new(), HashMap::new());
    for i in module.debug_names.iter().chain(&module.annotations) {
        match (i.class.opcode, i.operands.as_slice()) {
            (Op::Name, [Operand::IdRef(id), Operand::LiteralString(name)]) => drop(names.insert(*id, name.clone())),
            (Op::Decorate, [Operand::IdRef(id), Operand::Decoration(found), Operand::LiteralBit32(number)])
                if *found == decoration =>
            {
                numbers.insert(*id, *number);
            }
            _ => {}
        }
    }
    (names, numbers)
}

/// Arrays of structures have the host's stride.
#[test]
fn array_strides_are_the_host_s_sizes() {
    let sizes: HashMap<&str, usize> = layout::STRUCTS.iter().map(|(name, size, _)| (*name, *size)).collect();
    let mut checked = 0;
    for shader in SHADERS {
        let module = rspirv::dr::load_bytes(shader.spirv).expect("valid SPIR-V");
        let (names, strides) = names_and_decorations(&module, Decoration::ArrayStride);
        for i in &module.types_global_values {
            if let (Op::TypeRuntimeArray, [Operand::IdRef(element)]) = (i.class.opcode, i.operands.as_slice())
                && let (Some(name), Some(stride)) = (names.get(element), strides.get(&i.result_id.expect("a type")))
                && let Some(size) = sizes.get(name.as_str())
            {
                assert_eq!(*stride as usize, *size, "{name} in {}", shader.name);
                checked += 1;
            }
        }
    }
    assert!(checked >= 2, "only {checked} arrays were found");
}

/// Structures that the shaders read as texels have as many as the host writes. That each member is where it should be shows in every picture.
#[test]
fn structures_of_texels_have_the_host_s_sizes() {
    let source = std::fs::read_to_string(Path::new(ROOT).join("shaders/scene.glsl")).expect("the sources are here");
    for (name, size) in [
        ("OBJECT", size_of::<layout::Object>()),
        ("MATERIAL", size_of::<layout::Material>()),
        ("LUMINAIRE", size_of::<layout::Luminaire>()),
    ] {
        assert_eq!(size % 16, 0, "{name}");
        assert!(source.contains(&format!("const int {name}_TEXELS = {};", size / 16)), "{name}: {size} bytes");
    }
    // Where `load_material`, `load_luminaire` and `object_place` look for what is no vec4.
    let offset = |members: &[layout::Member], name: &str| members.iter().find(|m| m.0 == name).expect(name).1;
    let of_material = |name: &str| offset(layout::Material::MEMBERS, name);
    assert_eq!(["maps", "opacity_map", "one_sided"].map(of_material), [96, 112, 116]);
    let of_luminaire = |name: &str| offset(layout::Luminaire::MEMBERS, name);
    assert_eq!(["kind", "threshold", "alias_index", "triangle", "material"].map(of_luminaire), [80, 84, 88, 92, 96]);
    let of_object = |name: &str| offset(layout::Object::MEMBERS, name);
    assert_eq!(
        ["world_to_object", "root_node", "triangle_offset", "material", "scene_index"].map(of_object),
        [48, 96, 100, 104, 108]
    );
}

/// The specialization constants have the ids that the host gives them, by name.
#[test]
fn specialization_constants_have_the_host_s_order() {
    use luminaire::gpu::model::{Features, KernelModel};
    let expected: Vec<String> =
        Features::CONSTANTS.iter().chain(&KernelModel::CONSTANTS).map(|name| name.to_uppercase()).collect();
    for shader in SHADERS {
        let module = rspirv::dr::load_bytes(shader.spirv).expect("valid SPIR-V");
        let (names, ids) = names_and_decorations(&module, Decoration::SpecId);
        assert!(!ids.is_empty(), "{}", shader.name);
        for (id, spec) in ids {
            assert_eq!(Some(&names[&id]), expected.get(spec as usize), "constant {spec} in {}", shader.name);
        }
    }
}
