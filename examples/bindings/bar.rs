//! The bending of a bar, in Rust: 80 x 5 particles of iron, pinned at the left end, after a minute.
//!
//!     rustc -O bar.rs -L native=/path/of/the/library && ./bar
//!
//! SPDX-License-Identifier: MIT
use std::ffi::{c_char, c_void, CStr};
use std::ptr::{null, null_mut};

#[repr(C)]
#[derive(Clone, Copy)]
struct Material {
    struct_size: u32,
    particle_flags: u32,
    spring_flags: u32,
    mass: f32,
    stiffness: f32,
    damping: f32,
    break_strain: f32,
    warn_strain: f32,
    relax_strain: f32,
    yield_strain: f32,
    hardening: f32,
    plastic_limit: f32,
}

#[repr(C)]
struct LatticeDef {
    struct_size: u32,
    width: u32,
    height: u32,
    material_count: u32,
    x: f64,
    y: f64,
    spacing: f64,
    cells: *const u16,
    materials: *const Material,
    shear_share: f32,
    bend_share: f32,
}

#[repr(C)]
struct Settings {
    struct_size: u32,
    solver: i32,
    integrator: i32,
    guard: i32,
    substeps: u32,
    max_substeps: u32,
    substep_length: f64,
    gravity_x: f32,
    gravity_y: f32,
    global_damping: f32,
    max_speed: f32,
    sleep_speed: f32,
    sleep_time: f32,
    relax_fraction: f32,
    residual: f32,
    iterations: u32,
    tile_size: u32,
    coarse_period: u32,
    most_work: u32,
}

const PINNED: u32 = 1;

/// Structs that have defaults, with their numbers (mspring_struct).
trait Struct {
    const KIND: i32;
}
impl Struct for Material {
    const KIND: i32 = 4;
}
impl Struct for LatticeDef {
    const KIND: i32 = 5;
}
impl Struct for Settings {
    const KIND: i32 = 9;
}

#[link(name = "massspring")]
extern "C" {
    fn mspring_init(kind: i32, made: *mut c_void, size: usize) -> i32;
    fn mspring_result_string(result: i32) -> *const c_char;
    fn mspring_builder_create(allocator: *const c_void, builder: *mut *mut c_void) -> i32;
    fn mspring_builder_destroy(builder: *mut c_void);
    fn mspring_builder_add_lattice(builder: *mut c_void, def: *const LatticeDef, ids: *mut u32) -> i32;
    fn mspring_network_create(builder: *mut c_void, def: *const c_void, network: *mut *mut c_void) -> i32;
    fn mspring_network_destroy(network: *mut c_void);
    fn mspring_network_get_settings(network: *const c_void, settings: *mut Settings) -> i32;
    fn mspring_network_set_settings(network: *mut c_void, settings: *const Settings) -> i32;
    fn mspring_network_step(network: *mut c_void, dt: f64) -> i32;
    fn mspring_network_get_positions(
        network: *const c_void, ids: *const u32, first: u32, count: u32, x: *mut f64, y: *mut f64, stride: u32,
    ) -> i32;
    fn mspring_network_get_state_hash(network: *const c_void, hash: *mut u64) -> i32;
}

fn check(result: i32) -> Result<(), String> {
    match result {
        0 => Ok(()),
        _ => Err(unsafe { CStr::from_ptr(mspring_result_string(result)) }.to_string_lossy().into_owned()),
    }
}

/// A struct with its defaults; an error if the library has another layout of it.
fn made<T: Struct>() -> Result<T, String> {
    let mut made = unsafe { std::mem::zeroed::<T>() };
    check(unsafe { mspring_init(T::KIND, (&raw mut made).cast(), size_of::<T>()) })?;
    Ok(made)
}

struct Network(*mut c_void);

impl Network {
    /// The bar, and the particle at the top of its free end.
    fn bar(width: usize, height: usize) -> Result<(Network, u32), String> {
        let iron = Material { mass: 73.4, stiffness: 6.76e7, ..made()? };
        let materials = [iron, Material { particle_flags: PINNED, ..iron }]; // 0 is free, 1 is pinned
        let mut cells = vec![0u16; width * height];
        cells.iter_mut().step_by(width).for_each(|cell| *cell = 1);
        let mut ids = vec![0u32; width * height];
        let (mut builder, mut network) = (null_mut(), null_mut());
        unsafe {
            let def = LatticeDef {
                width: width as u32,
                height: height as u32,
                material_count: 2,
                cells: cells.as_ptr(),
                materials: materials.as_ptr(),
                ..made()?
            };
            check(mspring_builder_create(null(), &mut builder))?;
            let made = check(mspring_builder_add_lattice(builder, &def, ids.as_mut_ptr()))
                .and_then(|_| check(mspring_network_create(builder, null(), &mut network)));
            mspring_builder_destroy(builder);
            made?;
        }
        Ok((Network(network), ids[width - 1]))
    }

    fn height_of(&self, particle: u32) -> Result<f64, String> {
        let (mut x, mut y) = (0.0, 0.0);
        check(unsafe { mspring_network_get_positions(self.0, null(), particle, 1, &mut x, &mut y, 1) })?;
        Ok(y)
    }
}

impl Drop for Network {
    fn drop(&mut self) {
        unsafe { mspring_network_destroy(self.0) }
    }
}

fn main() -> Result<(), String> {
    let (network, free_end) = Network::bar(80, 5)?;
    let mut settings = made::<Settings>()?;
    check(unsafe { mspring_network_get_settings(network.0, &mut settings) })?;
    settings.global_damping = 1.0;
    check(unsafe { mspring_network_set_settings(network.0, &settings) })?;
    let top = network.height_of(free_end)?;
    for _ in 0..60 * 64 * 30 {
        check(unsafe { mspring_network_step(network.0, 1.0 / (64.0 * 30.0)) })?;
    }
    let mut hash = 0;
    check(unsafe { mspring_network_get_state_hash(network.0, &mut hash) })?;
    let drop = top - network.height_of(free_end)?;
    println!("the free end has dropped by {drop:.2} m, hash {hash:016x}");
    Ok(())
}
