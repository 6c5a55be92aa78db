//! The shader of scenes: material, lights, shadows and fog for eight pixels.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, i32x8, u32x8};

use super::light::PreparedLight;
use super::model::{AlphaMode, Fog, FogKind, Material, Shading};
use super::render::Look;
use crate::num::lanes::{each, max_f32, min_f32, truncate_f32};
use crate::space::{FragmentShader, Fragments, Shade, unpack};

/// Where the varyings are.
pub(super) const POSITION: usize = 0;
pub(super) const NORMAL: usize = 3;
pub(super) const UV: usize = 6;
pub(super) const COLOR: usize = 8;
/// Light reckoned at the vertices, and highlights.
pub(super) const LIGHT: usize = 12;
pub(super) const VARYINGS: usize = 16;

/// A vector for each of eight pixels.
pub(super) type Vector<S> = [f32x8<S>; 3];

/// The parts of a surface's colour that do not change over a draw.
pub(super) struct SurfaceShader<'a> {
    pub(super) look: Look,
    pub(super) material: &'a Material,
    pub(super) shading: Shading,
    pub(super) lights: &'a [PreparedLight],
    pub(super) ambient: f32,
    pub(super) fog: Option<Fog>,
    /// The eye in world space, and whether rays part from it; else `view` is the direction to the viewer everywhere.
    pub(super) eye: [f32; 3],
    pub(super) view: Option<[f32; 3]>,
    /// The number of the mesh's first primitive, for ids.
    pub(super) first_primitive: u32,
    pub(super) use_texture: bool,
    pub(super) depth_range: (f32, f32),
}

#[inline(always)]
pub(super) fn dot<S: Simd>(a: &Vector<S>, b: &Vector<S>) -> f32x8<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector over its length; a vector without length becomes 0.
#[inline(always)]
pub(super) fn normalized<S: Simd>(v: Vector<S>) -> Vector<S> {
    let simd = v[0].simd;
    let length = dot(&v, &v).sqrt();
    let zero = f32x8::splat(simd, 0.0);
    let inverse = f32x8::splat(simd, 1.0) / length;
    let inverse = length.simd_gt(zero).select(inverse, zero);
    each(simd, |i| v[i] * inverse)
}

/// e^x for x ≤ 0, within 2·10⁻⁷: 2 to the whole part by the exponent's bits, the rest by its series.
#[inline(always)]
pub(super) fn exp_negative<S: Simd>(x: f32x8<S>) -> f32x8<S> {
    let simd = x.simd;
    let x = max_f32(x * std::f32::consts::LOG2_E, f32x8::splat(simd, -126.0));
    let x = min_f32(x, f32x8::splat(simd, 0.0));
    let whole = truncate_f32(x - 0.5);
    let rest = x - whole.to_float::<f32x8<S>>();
    // 2^rest with |rest| ≤ ½, by Taylor's series to the sixth power.
    let p = rest * 1.540_353e-4 + 1.333_355_8e-3;
    let p = p * rest + 9.618_129e-3;
    let p = p * rest + 5.550_411e-2;
    let p = p * rest + 0.240_226_5;
    let p = p * rest + 0.693_147_2;
    let p = p * rest + 1.0;
    let scale: f32x8<S> = ((whole + 127) << 23).bitcast();
    p * scale
}

/// How much of a surface shows through fog at distances `w`.
#[inline(always)]
fn fog_factor<S: Simd>(kind: FogKind, w: f32x8<S>) -> f32x8<S> {
    let simd = w.simd;
    let f = match kind {
        FogKind::Linear { start, end } => (f32x8::splat(simd, end) - w) * (1.0 / (end - start)),
        FogKind::Exponential(density) => exp_negative(w * -density),
        FogKind::ExponentialSquared(density) => {
            let d = w * density;
            exp_negative(-(d * d))
        }
    };
    min_f32(max_f32(f, f32x8::splat(simd, 0.0)), f32x8::splat(simd, 1.0))
}

/// `x` to a whole power, by squaring.
#[inline(always)]
fn power<S: Simd>(x: f32x8<S>, exponent: u32) -> f32x8<S> {
    let mut result = f32x8::splat(x.simd, 1.0);
    let (mut base, mut rest) = (x, exponent);
    while rest > 0 {
        if rest & 1 == 1 {
            result *= base;
        }
        base = base * base;
        rest >>= 1;
    }
    result
}

impl SurfaceShader<'_> {
    /// Base colour (straight) and alpha.
    #[inline(always)]
    fn base<S: Simd>(&self, f: &Fragments<'_, S>) -> [f32x8<S>; 4] {
        let mut base: [f32x8<S>; 4] = each(f.simd(), |i| f.varying(COLOR + i) * self.material.color[i]);
        if let Some(texture) = self.material.texture.as_ref().filter(|_| self.use_texture) {
            let [u, v] = f.varyings(UV);
            let texel = unpack(texture.sample_grad(u, v, f.derivatives(UV), f.derivatives(UV + 1)));
            let zero = f32x8::splat(f.simd(), 0.0);
            // Texels are premultiplied.
            let visible = texel[3].simd_gt(zero);
            let inverse = visible.select(f32x8::splat(f.simd(), 1.0) / texel[3], zero);
            for i in 0..3 {
                base[i] *= texel[i] * inverse;
            }
            base[3] *= texel[3];
        }
        base
    }

    /// The triangle's own normal, turned to the viewer.
    #[inline(always)]
    fn face_normal<S: Simd>(&self, f: &Fragments<'_, S>) -> Vector<S> {
        let p = |k: usize| [0, 1, 2].map(|i| f.corner(k, POSITION + i));
        let (a, b, c) = (p(0), p(1), p(2));
        let (u, v): ([f32; 3], [f32; 3]) = (std::array::from_fn(|i| b[i] - a[i]), std::array::from_fn(|i| c[i] - a[i]));
        let mut n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        let to_eye = self.view.unwrap_or(std::array::from_fn(|i| self.eye[i] - a[i]));
        if n[0] * to_eye[0] + n[1] * to_eye[1] + n[2] * to_eye[2] < 0.0 {
            n = n.map(|v| -v);
        }
        normalized(each(f.simd(), |i| f32x8::splat(f.simd(), n[i])))
    }

    /// The direction from places to the viewer.
    #[inline(always)]
    fn to_viewer<S: Simd>(&self, simd: S, position: &Vector<S>) -> Vector<S> {
        match self.view {
            Some(view) => each(simd, |i| f32x8::splat(simd, view[i])),
            None => normalized(each(simd, |i| f32x8::splat(simd, self.eye[i]) - position[i])),
        }
    }

    /// Phong's diffuse share and highlight, summed over the lights.
    #[inline(always)]
    pub(super) fn phong<S: Simd>(
        &self,
        simd: S,
        position: &Vector<S>,
        normal: &Vector<S>,
        mask: u8,
    ) -> (Vector<S>, Vector<S>) {
        let zero = f32x8::splat(simd, 0.0);
        let viewer = self.to_viewer(simd, position);
        let (mut diffuse, mut highlight) = ([zero; 3], [zero; 3]);
        for light in self.lights {
            let (direction, strength) = light.at(simd, position);
            let cosine = dot(normal, &direction);
            let lit = cosine.simd_gt(zero);
            let strength = light.shadowed(position, strength, mask);
            let cosine = lit.select(cosine, zero) * strength;
            let half = normalized(each(simd, |i| direction[i] + viewer[i]));
            let shine = dot(normal, &half);
            let shine = shine.simd_gt(zero).select(shine, zero);
            let shine = power(shine, self.material.shininess.clamp(1, 1024)) * strength * self.material.specular;
            let shine = lit.select(shine, zero);
            for i in 0..3 {
                diffuse[i] += cosine * light.color[i];
                highlight[i] += shine * light.color[i];
            }
        }
        (diffuse, highlight)
    }

    /// Metallic-roughness: see [`Shading::Pbr`].
    #[inline(always)]
    fn pbr<S: Simd>(&self, base: &[f32x8<S>; 4], position: &Vector<S>, normal: &Vector<S>, mask: u8) -> Vector<S> {
        let simd = base[0].simd;
        let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let viewer = self.to_viewer(simd, position);
        let nv = dot(normal, &viewer);
        // Seen from behind: the other side's normal.
        let turned = nv.simd_lt(zero);
        let normal: Vector<S> = each(simd, |i| turned.select(-normal[i], normal[i]));
        let nv = turned.select(-nv, nv) + 1e-4;
        let metallic = self.material.metallic.clamp(0.0, 1.0);
        let roughness = self.material.roughness.clamp(0.045, 1.0);
        let alpha = roughness * roughness;
        let alpha2 = alpha * alpha;
        let k = alpha * 0.5;
        let mut out: Vector<S> = each(simd, |i| base[i] * self.ambient);
        for light in self.lights {
            let (direction, strength) = light.at(simd, position);
            let nl = dot(&normal, &direction);
            let nl = nl.simd_gt(zero).select(nl, zero);
            let strength = light.shadowed(position, strength, mask) * nl * (1.0 - self.ambient);
            let half = normalized(each(simd, |i| direction[i] + viewer[i]));
            let (nh, vh) = (dot(&normal, &half), dot(&viewer, &half));
            let (nh, vh) = (max_f32(nh, zero), min_f32(max_f32(vh, zero), one));
            let d = nh * nh * (alpha2 - 1.0) + 1.0;
            // The light's π cancels with the distribution's.
            let distribution = f32x8::splat(simd, alpha2) / (d * d);
            let visibility = one / ((nl * (1.0 - k) + k) * (nv * (1.0 - k) + k) * 4.0);
            let grazing = power(one - vh, 5);
            for i in 0..3 {
                let f0 = base[i] * metallic + 0.04 * (1.0 - metallic);
                let fresnel = f0 + (one - f0) * grazing;
                let diffuse = (one - fresnel) * (1.0 - metallic) * base[i];
                out[i] += (diffuse + fresnel * distribution * visibility) * strength * light.color[i];
            }
        }
        out
    }
}

impl FragmentShader for SurfaceShader<'_> {
    fn may_discard(&self) -> bool {
        self.look == Look::Materials && matches!(self.material.alpha, AlphaMode::Mask(_))
    }

    #[inline(always)]
    fn shade<S: Simd>(&self, f: &Fragments<'_, S>) -> Shade<S> {
        let simd = f.simd();
        match self.look {
            Look::Ids => {
                let id = f.primitive().wrapping_add(self.first_primitive).wrapping_add(1);
                return Shade::packed(u32x8::splat(simd, id | 0xff00_0000));
            }
            Look::Normals => {
                let normal = normalized(f.varyings(NORMAL));
                return Shade::opaque(each(simd, |i| normal[i] * 0.5 + 0.5));
            }
            Look::Depth => {
                let (near, far) = self.depth_range;
                let shown = (f32x8::splat(simd, far) - f.w()) * (1.0 / (far - near));
                return Shade::opaque([shown; 3]);
            }
            Look::Materials => {}
        }
        let one = f32x8::splat(simd, 1.0);
        let mut base = self.base(f);
        let mut keep = !0;
        match self.material.alpha {
            AlphaMode::Opaque => base[3] = one,
            AlphaMode::Mask(cut) => {
                keep = base[3].simd_ge(f32x8::splat(simd, cut)).to_bitmask() as u8;
                base[3] = one;
            }
            AlphaMode::Blend => {}
        }
        let ambient = self.ambient;
        let mut rgb: Vector<S> = match self.shading {
            Shading::Unlit => [base[0], base[1], base[2]],
            Shading::Gouraud => {
                let light: Vector<S> = f.varyings(LIGHT);
                let shine = f.varying(LIGHT + 3);
                each(simd, |i| base[i] * light[i] + shine)
            }
            Shading::Pbr => {
                let (position, normal) = (f.varyings(POSITION), normalized(f.varyings(NORMAL)));
                self.pbr(&base, &position, &normal, f.mask())
            }
            Shading::Flat | Shading::Phong => {
                let position = f.varyings(POSITION);
                let normal = match self.shading {
                    Shading::Flat => self.face_normal(f),
                    _ => normalized(f.varyings(NORMAL)),
                };
                let (diffuse, highlight) = self.phong(simd, &position, &normal, f.mask());
                each(simd, |i| base[i] * (diffuse[i] * (1.0 - ambient) + ambient) + highlight[i])
            }
        };
        if let Some(fog) = self.fog {
            let factor = fog_factor(fog.kind, f.w());
            for i in 0..3 {
                rgb[i] = rgb[i] * factor + (one - factor) * fog.color[i];
            }
        }
        let rgb = each(simd, |i| min_f32(max_f32(rgb[i], f32x8::splat(simd, 0.0)), one));
        let alpha = min_f32(max_f32(base[3], f32x8::splat(simd, 0.0)), one);
        let mut shade = match self.material.alpha {
            AlphaMode::Blend => Shade::color([rgb[0] * alpha, rgb[1] * alpha, rgb[2] * alpha, alpha]),
            _ => Shade::opaque(rgb),
        };
        shade.keep = keep;
        shade
    }
}

/// Eight integers from floats within ±2^31, rounded towards 0; anything else becomes 0.
#[inline(always)]
pub(super) fn to_integers<S: Simd>(v: f32x8<S>) -> i32x8<S> {
    let simd = v.simd;
    let bounded = v.simd_gt(f32x8::splat(simd, -1e9)) & v.simd_lt(f32x8::splat(simd, 1e9));
    truncate_f32(bounded.select(v, f32x8::splat(simd, 0.0)))
}
