//! The shipped SPIR-V is what the GLSL gives, and its structures are those of the host. No GPU needed.

use luminaire::gpu::{SHADERS, layout};
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, ExecutionMode, Op};
use std::collections::HashMap;
use std::io::Write;
use std::path::Path;
use std::process::Command;
use std::sync::LazyLock;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The sources compiled into a folder with an option for the compiler. `None`, and a line that says so, where there is no compiler.
fn compiled(option: &str) -> Option<tempfile::TempDir> {
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = Command::new("bash");
    command.arg("scripts/build-shaders.sh").arg(folder.path()).arg(option).current_dir(ROOT);
    match command.output() {
        Ok(output) if output.status.success() => Some(folder),
        Ok(output) if !String::from_utf8_lossy(&output.stderr).contains("glslc is missing") => {
            panic!("{}", String::from_utf8_lossy(&output.stderr))
        }
        _ => {
            assert!(std::env::var_os("LUMINAIRE_REQUIRE_GPU").is_none(), "glslc is missing");
            let _ = writeln!(std::io::stderr(), "SKIP: glslc is missing; the sources were not compiled");
            None
        }
    }
}

/// Modules with the names of the sources, which optimised ones have lost; those have the same layouts, because [`shipped_spirv_is_what_the_sources_give`].
fn named_modules() -> &'static [(&'static str, Module)] {
    static MODULES: LazyLock<Vec<(&str, Module)>> = LazyLock::new(|| {
        let Some(folder) = compiled("-O0") else { return Vec::new() };
        let module = |name: &'static str| {
            let spirv = std::fs::read(folder.path().join(format!("{name}.spv"))).expect("compiled");
            (name, rspirv::dr::load_bytes(spirv).expect("valid SPIR-V"))
        };
        SHADERS.iter().map(|shader| module(shader.name)).collect()
    });
    &MODULES
}

/// Same compiler: same bytes. Another compiler: the sources still compile, and have not changed since the SPIR-V was made.
#[test]
fn shipped_spirv_is_what_the_sources_give() {
    let shipped = Path::new(ROOT).join("shaders/spirv");
    let Some(folder) = compiled("-O") else { return };
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
fn structures(module: &Module) -> HashMap<String, Vec<(String, u32)>> {
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
    for (shader, module) in named_modules() {
        let found = structures(module);
        for (name, size, members) in layout::STRUCTS {
            let Some(in_shader) = found.get(*name) else { continue };
            seen.push(*name);
            let expected: Vec<(String, u32)> = members
                .iter()
                .filter(|(member, _)| in_shader.iter().any(|(m, _)| m == member) || !member.starts_with("padding"))
                .map(|(member, offset)| (member.to_string(), *offset as u32))
                .collect();
            assert_eq!(in_shader, &expected, "{name} in {shader}");
            assert_eq!(size % 4, 0);
        }
    }
    for (name, ..) in layout::STRUCTS {
        assert!(seen.contains(name) || named_modules().is_empty(), "no shader has {name}");
    }
}

/// Names of a module by their ids, and the numbers of one decoration.
fn names_and_decorations(module: &Module, decoration: Decoration) -> (HashMap<u32, String>, HashMap<u32, u32>) {
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
    for (shader, module) in named_modules() {
        let (names, strides) = names_and_decorations(module, Decoration::ArrayStride);
        for i in &module.types_global_values {
            if let (Op::TypeRuntimeArray, [Operand::IdRef(element)]) = (i.class.opcode, i.operands.as_slice())
                && let (Some(name), Some(stride)) = (names.get(element), strides.get(&i.result_id.expect("a type")))
                && let Some(size) = sizes.get(name.as_str())
            {
                assert_eq!(*stride as usize, *size, "{name} in {shader}");
                checked += 1;
            }
        }
    }
    assert!(checked >= 2 || named_modules().is_empty(), "only {checked} arrays were found");
}

/// The text of every shader and of what they include, with the file's name.
fn sources() -> Vec<(String, String)> {
    let folder = std::fs::read_dir(Path::new(ROOT).join("shaders")).expect("the sources are here");
    let paths = folder.map(|entry| entry.expect("an entry").path());
    paths
        .filter(|path| path.extension().is_some_and(|ending| ending == "glsl" || ending == "comp"))
        .map(|path| {
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            (name, std::fs::read_to_string(&path).expect("a text"))
        })
        .collect()
}

/// Names of a GLSL structure's members with the bytes at which they lie if it is read from texels in its order: a vector of three begins a
/// texel, and what follows it fills that up.
fn members_in_texels(name: &str) -> Vec<(String, usize)> {
    let head = format!("\nstruct {name} {{\n");
    let (_, text) = sources().into_iter().find(|(_, text)| text.contains(&head)).expect(name);
    let body = text.split_once(&head).expect("it was found").1.split_once("\n};").expect("an end").0;
    let mut end = 0usize;
    let mut members = vec![];
    for line in body.lines() {
        let mut words = line.split_once(';').expect("a member").0.split_whitespace();
        let (start, size) = match words.next().expect("a type") {
            "vec3" => (end.next_multiple_of(16), 12),
            "float" | "uint" | "bool" => (end, 4),
            other => panic!("{name} has a {other}"),
        };
        end = start + size;
        members.push((words.next().expect("a name").to_string(), start));
    }
    members
}

/// Structures that the shaders read as texels have the host's members at the host's places, and as many texels.
#[test]
fn structures_of_texels_are_laid_out_alike() {
    let of_host = |members: &[layout::Member], first: usize| -> Vec<(String, usize)> {
        let named = members.iter().filter(|(member, offset)| !member.starts_with("padding") && *offset >= first);
        named.map(|(member, offset)| (member.to_string(), offset - first)).collect()
    };
    for (name, members) in [
        ("Triangle", layout::Triangle::MEMBERS),
        ("Material", layout::Material::MEMBERS),
        ("Physical", layout::Physical::MEMBERS),
        ("Texture", layout::Texture::MEMBERS),
        ("EnvironmentTexel", layout::EnvironmentTexel::MEMBERS),
    ] {
        assert_eq!(members_in_texels(name), of_host(members, 0), "{name}");
    }
    // Behind the two maps.
    let place = std::mem::offset_of!(layout::Object, root_node);
    assert_eq!((place, std::mem::offset_of!(layout::Object, world_to_object)), (96, 48));
    assert_eq!(members_in_texels("ObjectPlace"), of_host(layout::Object::MEMBERS, place));
    // The slot of the alias table is read by itself.
    let luminaire = of_host(layout::Luminaire::MEMBERS, 0);
    let in_shader = members_in_texels("Luminaire");
    let kind = in_shader.iter().position(|(member, _)| member == "kind").expect("a kind");
    assert_eq!(in_shader[..=kind], luminaire[..=kind]);
    assert_eq!(
        luminaire[kind..].iter().map(|(member, offset)| (member.as_str(), *offset)).collect::<Vec<_>>(),
        [("kind", 80), ("threshold", 84), ("alias_index", 88), ("triangle", 92), ("material", 96)]
    );
}

/// Every constant of the shaders, with its file.
fn constants() -> Vec<(String, String, String)> {
    let mut found = vec![];
    for (file, text) in sources() {
        for line in text.lines().filter_map(|line| line.strip_prefix("const ")) {
            let (definition, _) = line.split_once(';').expect("a constant on one line");
            let (declaration, value) = definition.split_once(" = ").expect("a value");
            let name = declaration.split_whitespace().last().expect("a name");
            found.push((file.clone(), name.to_string(), value.to_string()));
        }
    }
    found
}

/// A GLSL number.
fn number(text: &str) -> Option<f64> {
    let text = text.strip_suffix('u').unwrap_or(text);
    match text.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16).ok().map(f64::from),
        None => text.parse().ok(),
    }
}

/// Constants of the shaders that the host has no twin of: what they are for is the shaders' own affair.
const OWN: [&str; 3] = [
    "FAR_AWAY",  // in place of an infinity
    "RAY_FLAGS", // of ray queries
    "IMPULSE",   // stands for a density that there is none of
];

/// Constants that the host has too, by their names in the shaders.
fn twins() -> Vec<(&'static str, f64)> {
    use layout::LuminaireKind;
    use luminaire::film::{GROUPS_IN_TURN, MOST_RADIANCE};
    use luminaire::gpu::bvh::{CwBvhNode, STACK_SIZE};
    use luminaire::gpu::pack::luminaire as bounds;
    use luminaire::gpu::probe::Function;
    use luminaire::gpu::specialization::{directions_number, extinction_number, light_sampling_number};
    use luminaire::reference::{light_tree as choice, luminaire as light, normal_map, path, physical, scatter};
    use luminaire::sampling::{CDF_NUMBERS, SENSOR_BLOCK};
    use luminaire::scene::{
        Directions, Extinction, Filter, LEAST_ALPHA, LightSampling, albedo_table, brushed_table, light_tree,
    };
    use std::f64::consts::{FRAC_PI_4, PI};

    assert_eq!(Filter::Box.inverse_cdf(0.5).len().div_ceil(4), layout::FILTER_TEXELS);
    let texels = |size: usize| {
        assert_eq!(size % 16, 0);
        (size / 16) as f64
    };
    let mut twins = vec![
        ("PI", PI),
        ("QUARTER_PI", FRAC_PI_4),
        ("INFINITY_BITS", f32::INFINITY.to_bits().into()),
        ("NONE", layout::NONE.into()),
        ("MISSED", layout::MISSED.into()),
        ("BY_ALBEDOS", layout::BY_ALBEDOS.into()),
        ("MIRROR", layout::MIRROR.into()),
        ("LONGEST_EDGE", layout::LONGEST_EDGE.into()),
        ("HAS_PLANE", layout::HAS_PLANE.into()),
        ("FILTER_TEXELS", layout::FILTER_TEXELS as f64),
        ("TRIANGLE_TEXELS", texels(size_of::<layout::Triangle>())),
        ("OBJECT_TEXELS", texels(size_of::<layout::Object>())),
        ("PHYSICAL_TEXELS", texels(size_of::<layout::Physical>())),
        ("ROUGH", albedo_table::ROUGH as f64),
        ("STEEP", albedo_table::STEEP as f64),
        ("ROUGHNESSES", albedo_table::ROUGHNESSES as f64),
        ("COSINES", albedo_table::COSINES as f64),
        ("ALONG", brushed_table::ALONG as f64),
        ("RATIOS", brushed_table::RATIOS as f64),
        ("AROUND", brushed_table::AROUND as f64),
        ("TILTS", brushed_table::TILTS as f64),
        ("MEANS_ALONG", brushed_table::MEANS_ALONG as f64),
        ("MEANS_RATIOS", brushed_table::MEANS_RATIOS as f64),
        ("BRUSHED_ALONG", brushed_table::BRUSHED_ALONG as f64),
        ("BRUSHED_RATIOS", brushed_table::BRUSHED_RATIOS as f64),
        ("BRUSHED_ASIDE", brushed_table::BRUSHED_ASIDE as f64),
        ("BRUSHED_TILTS", brushed_table::BRUSHED_TILTS as f64),
        ("BRUSHED_ROW", brushed_table::BRUSHED_ROW as f64),
        ("LEAST_INSIDE", brushed_table::LEAST_INSIDE),
        ("LEAST_ALPHA", LEAST_ALPHA),
        ("COAT_INDEX", luminaire::scene::COAT_INDEX),
        ("EDGE_COVARIANCE", physical::EDGE_COVARIANCE),
        ("LEAST_SHARE", physical::LEAST_SHARE),
        ("LEAST_COSINE", physical::LEAST_COSINE),
        ("NARROW", physical::NARROW),
        ("WIDE", physical::WIDE),
        ("INSIDE", luminaire::gpu::probe::INSIDE.into()),
        ("MATERIAL_TEXELS", texels(size_of::<layout::Material>())),
        ("LUMINAIRE_TEXELS", texels(size_of::<layout::Luminaire>())),
        ("LIGHT_NODE_TEXELS", texels(size_of::<layout::LightNode>())),
        ("LIGHT_TREE_HEADER", layout::LIGHT_TREE_HEADER as f64),
        ("LEAF", light_tree::LEAF.into()),
        ("ORDINAL_SHIFT", layout::ORDINAL_SHIFT.into()),
        ("HORIZON_MARGIN", choice::HORIZON_MARGIN),
        ("LEAST_SQUARE", normal_map::LEAST_SQUARE),
        ("LEAST_REFLECTED", normal_map::LEAST_REFLECTED),
        ("MOST_SINE", choice::MOST_SINE),
        ("LEAST_IMPORTANCE", choice::LEAST_IMPORTANCE),
        ("LEAST_DISTANCE2", choice::LEAST_DISTANCE2),
        ("INNER_SIDE", choice::INNER_SIDE),
        ("LEAST_WIDTH", choice::LEAST_WIDTH.into()),
        ("LAST_FRACTION", choice::LAST_FRACTION),
        ("MOST_NUMBERS", choice::MOST_NUMBERS),
        ("CONE_COSINE_MARGIN", choice::CONE_COSINE_MARGIN),
        ("TEXTURE_TEXELS", texels(size_of::<layout::Texture>())),
        ("NODE_TEXELS", texels(size_of::<CwBvhNode>())),
        ("STACK_SIZE", STACK_SIZE as f64),
        ("MOST_RADIANCE", MOST_RADIANCE),
        ("GROUPS_IN_TURN", GROUPS_IN_TURN.into()),
        ("SENSOR_BLOCK", SENSOR_BLOCK.into()),
        ("LONGEST_PATH", f64::from(path::LONGEST_PATH)),
        ("SURE_THROUGHPUT", scatter::SURE_THROUGHPUT),
        ("SURE_IMPULSES", scatter::SURE_IMPULSES.into()),
        ("AMPLE_THROUGHPUT", scatter::AMPLE_THROUGHPUT),
        ("NEAR", light::NEAR),
        ("LEAST_SOLID_ANGLE", light::LEAST_SOLID_ANGLE),
        ("UNIT_ROUNDOFF", bounds::UNIT_ROUNDOFF),
        ("POINT_ROUNDINGS", bounds::POINT_ROUNDINGS),
        ("PLANE_ROUNDINGS", bounds::PLANE_ROUNDINGS),
        ("MOST_NARROW", bounds::MOST_NARROW),
        ("TO_OBJECT_ROUNDINGS", bounds::TO_OBJECT_ROUNDINGS),
        ("TO_WORLD_ROUNDINGS", bounds::TO_WORLD_ROUNDINGS),
    ];
    let numbers = [
        ("POINT", LuminaireKind::Point as u32),
        ("INFINITE", LuminaireKind::Infinite as u32),
        ("AREA", LuminaireKind::Area as u32),
        ("SURROUNDINGS", LuminaireKind::Surroundings as u32),
        ("SPOT", LuminaireKind::Spot as u32),
        ("PHOTOMETRIC", LuminaireKind::Photometric as u32),
        ("SUN", LuminaireKind::Sun as u32),
        ("LIGHT_NONE", light_sampling_number(LightSampling::None)),
        ("LIGHT_DIRECT", light_sampling_number(LightSampling::Direct)),
        ("LIGHT_MIS", light_sampling_number(LightSampling::Mis)),
        ("DIRECTIONS_UNIFORM", directions_number(Directions::Uniform)),
        ("DIRECTIONS_COSINE", directions_number(Directions::Cosine)),
        ("DIRECTIONS_BSDF", directions_number(Directions::Bsdf)),
        ("EXTINCTION_OFF", extinction_number(Extinction::Off)),
        ("EXTINCTION_LITERAL", extinction_number(Extinction::Literal)),
        ("EXTINCTION_SURFACE", extinction_number(Extinction::Surface)),
        ("EXTINCTION_THROUGHPUT", extinction_number(Extinction::Throughput)),
        ("CDF_NUMBERS", CDF_NUMBERS),
        ("RANDOM4", Function::Random4 as u32),
        ("CLOSEST_HIT", Function::ClosestHit as u32),
        ("OCCLUDED", Function::Occluded as u32),
        ("COSINE_HEMISPHERE", Function::CosineHemisphere as u32),
        ("UNIFORM_TRIANGLE", Function::UniformTriangle as u32),
        ("CHOOSE_LUMINAIRE", Function::ChooseLuminaire as u32),
        ("BSDF", Function::Bsdf as u32),
        ("LEAVE", Function::Leave as u32),
        ("UNIFORM_HEMISPHERE", Function::UniformHemisphere as u32),
        ("GLOSSY_HALF_VECTOR", Function::GlossyHalfVector as u32),
        ("SCATTER", Function::Scatter as u32),
        ("CHOOSE_BY_TREE", Function::ChooseByTree as u32),
        ("TREE_PROBABILITY", Function::TreeProbability as u32),
        ("SPHERICAL_TRIANGLE", Function::SphericalTriangle as u32),
        ("SAMPLE_SUN", Function::SampleSun as u32),
        ("INTENSITY", Function::Intensity as u32),
        ("SAMPLE_ENVIRONMENT", Function::SampleEnvironment as u32),
        ("ENVIRONMENT_AT", Function::EnvironmentAt as u32),
        ("TEXTURE_AT", Function::TextureAt as u32),
        ("REFRACT", Function::Refract as u32),
        ("SENSOR_RAY", Function::SensorRay as u32),
        ("NUMBERS", Function::Numbers as u32),
        ("COVERAGE", Function::Coverage as u32),
        ("SIN_COS", Function::SinCos as u32),
    ];
    twins.extend(numbers.map(|(name, value)| (name, f64::from(value))));
    twins
}

/// Every constant of the shaders has the host's value, or is listed as their own.
#[test]
fn constants_are_the_host_s() {
    let twins = twins();
    let constants = constants();
    for (file, name, value) in &constants {
        let same_name = constants.iter().filter(|(_, other, _)| other == name).count();
        assert_eq!(same_name, 1, "{name} of {file} is defined again elsewhere");
        if OWN.contains(&name.as_str()) {
            continue;
        }
        let twin = twins.iter().find(|(twin, _)| twin == name);
        let (_, expected) = twin.unwrap_or_else(|| panic!("{name} of {file} is in neither list of this test"));
        let found = number(value).unwrap_or_else(|| panic!("{name} of {file} is {value}: no number"));
        // Integers exactly, others as the shader rounds them.
        assert!(
            found == *expected || found as f32 == *expected as f32 && found.fract() != 0.0,
            "{name} of {file}: {value}, here {expected}"
        );
    }
    let known = twins.iter().map(|(name, _)| *name).chain(OWN);
    for name in known {
        assert!(constants.iter().any(|(_, found, _)| found == name), "no shader has {name}");
    }
}

/// The numbers that the hash functions are made of stand on both sides. `gpu::functions` compares what comes of them, where there is a
/// device.
#[test]
fn hashes_have_the_host_s_numbers() {
    let words = |text: &str| -> Vec<String> {
        let code = text.lines().map(|line| line.split("//").next().unwrap_or_default());
        code.flat_map(|line| line.split(|c: char| !c.is_ascii_alphanumeric() && c != '_'))
            .map(|word| word.replace('_', ""))
            .filter(|word| word.len() > 5 && word.starts_with(|c: char| c.is_ascii_digit()))
            .map(|word| word.trim_end_matches('u').to_string())
            .collect()
    };
    let read = |file: &str| std::fs::read_to_string(Path::new(ROOT).join(file)).expect("a source");
    let files = ["mod", "random", "sampler", "sobol"].map(|name| read(&format!("src/sampling/{name}.rs")));
    let host = files.map(|text| words(&text)).concat();
    let shader = words(&read("shaders/rng.glsl"));
    assert!(shader.len() >= 10, "{shader:?}");
    for word in shader {
        // 2^23, which the host writes as a power.
        assert!(word == "8388608" || host.contains(&word), "{word} is not in src/sampling");
    }
}

/// Workgroups are as large as the host takes them to be.
#[test]
fn workgroups_have_the_host_s_sizes() {
    for shader in SHADERS {
        let module = rspirv::dr::load_bytes(shader.spirv).expect("valid SPIR-V");
        let size = module.execution_modes.iter().find_map(|mode| match mode.operands.as_slice() {
            [
                _,
                Operand::ExecutionMode(ExecutionMode::LocalSize),
                Operand::LiteralBit32(x),
                Operand::LiteralBit32(y),
                Operand::LiteralBit32(z),
            ] => Some([*x, *y, *z]),
            _ => None,
        });
        let tiles = shader.name.starts_with("path_trace") || shader.name.starts_with("aov");
        let expected =
            if tiles { [layout::TILE_WORKGROUP, layout::TILE_WORKGROUP, 1] } else { [layout::ROW_WORKGROUP, 1, 1] };
        assert_eq!(size, Some(expected), "{}", shader.name);
    }
}

/// The specialization constants have the ids that the host gives them, by name.
#[test]
fn specialization_constants_have_the_host_s_order() {
    use luminaire::gpu::specialization::{Features, KernelModel};
    let expected: Vec<String> =
        Features::CONSTANTS.iter().chain(&KernelModel::CONSTANTS).map(|name| name.to_uppercase()).collect();
    for (shader, module) in named_modules() {
        let (names, ids) = names_and_decorations(module, Decoration::SpecId);
        assert!(!ids.is_empty(), "{shader}");
        for (id, spec) in ids {
            assert_eq!(Some(&names[&id]), expected.get(spec as usize), "constant {spec} in {shader}");
        }
    }
}

/// No shader binds more, or larger things, than a device is asked for; and that is no more than Vulkan guarantees (a test beside it).
#[test]
fn shaders_need_no_more_than_is_asked_for() {
    use luminaire::gpu::NEEDS;
    use rspirv::spirv::{Dim, StorageClass};
    for shader in SHADERS {
        let module = rspirv::dr::load_bytes(shader.spirv).expect("valid SPIR-V");
        let result = |id: u32| module.types_global_values.iter().find(|i| i.result_id == Some(id));
        let (mut uniform, mut storage, mut texels, mut others) = (0, 0, 0, 0);
        for variable in module.types_global_values.iter().filter(|i| i.class.opcode == Op::Variable) {
            let Operand::StorageClass(class) = variable.operands[0] else { panic!("a variable without a class") };
            let pointer = result(variable.result_type.expect("a type")).expect("a pointer");
            let Operand::IdRef(pointee) = pointer.operands[1] else { panic!("a pointer to nothing") };
            let pointee = result(pointee).expect("a type");
            match class {
                StorageClass::Uniform => uniform += 1,
                StorageClass::StorageBuffer => storage += 1,
                StorageClass::UniformConstant if pointee.class.opcode == Op::TypeSampledImage => {
                    let Operand::IdRef(image) = pointee.operands[0] else { panic!("of no image") };
                    let image = result(image).expect("an image");
                    assert!(image.operands.contains(&Operand::Dim(Dim::DimBuffer)), "{}", shader.name);
                    texels += 1;
                }
                StorageClass::UniformConstant => others += 1,
                _ => {}
            }
        }
        let name = shader.name;
        assert!(uniform <= NEEDS.uniform_buffers && storage <= NEEDS.storage_buffers, "{name}: {uniform}, {storage}");
        assert!(texels <= NEEDS.texel_buffers, "{name}: {texels} texel buffers");
        assert!(!name.starts_with("path_trace") || uniform == 1 && texels > 2, "{name}: only {texels} texel buffers");
        assert!(uniform + storage + texels + others <= NEEDS.resources, "{name}");
    }
    for (name, size, _) in layout::STRUCTS {
        let limit = if *name == "Frame" { NEEDS.uniform_bytes } else { u32::MAX };
        assert!(*size as u32 <= limit, "{name}");
        let pushed = ["Batch", "Call", "Shots"].contains(name);
        assert!(!pushed || *size as u32 <= NEEDS.push_constants, "{name}");
    }
    assert!(layout::TILE_WORKGROUP.pow(2) <= NEEDS.invocations && layout::ROW_WORKGROUP <= NEEDS.invocations);
}
