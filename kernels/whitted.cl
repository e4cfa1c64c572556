// SPDX-License-Identifier: Apache-2.0
//
// Whitted's recursion, as a loop: the color seen along a ray is the local light plus mirror x the
// color along the mirror ray plus transmission x the color along the refracted ray. `throughput` is
// the product of these weights so far; a path ends when it is black, when a ray misses, or after
// max_bounces mirror and refracted rays together.
//
// Where a hit spawns both, the refracted ray is pushed on a stack and the mirror ray followed; when
// no lane of the packet is live, the ray on top is resumed. So each lane walks its ray tree, and
// adds up its colors, in the same order whatever the packet. A branch at a transmitting surface
// that is too faint to change a picture is dropped.
//
// A ray enters where it meets the front of the geometric normal, whether or not two_sided flips it.
#ifndef RT_WHITTED_CL
#define RT_WHITTED_CL

#include "kernels/camera.cl"
#include "kernels/shade.cl"

#ifndef RT_OUT_OF_LINE  // native.cl compiles the tracer once for all its entry points
#define RT_OUT_OF_LINE
#endif

// The mirror ray at a surface. Where an interpolated normal would send it below the surface, it is
// reflected about the geometric normal instead.
Ray mirror_ray(const Surface* surface, real3 dir, Indices prim) {
    real3 mirrored = reflect3(dir, surface->normal);
    if (RT_HAS(VERTEX_NORMALS)) {
        Reals arriving = dot3(dir, surface->geometric);
        Mask leaves = dot3(mirrored, surface->geometric) * arriving < (Reals)0;
        mirrored = select3(leaves, mirrored, reflect3(dir, surface->geometric));
    }
    mirrored = normalize3(mirrored);
    return spawn_ray(surface, offset_origin(surface, mirrored), mirrored, prim);
}

// Notes on a refracted ray which of the surfaces around its origin it has crossed (Ray::zone):
// those up to four times as far as this one. `inside` where it came from behind the surface.
void note_crossed(const SceneView* scene, const Surface* surface, real3 dir, Mask inside,
                  Indices prim, Ray* ray) {
    Mask touching = surface->back > (Reals)0;
    Reals depth = fma(surface->back, fabs(dot3(dir, surface->geometric)), surface->offset);
    Reals reach = (Reals)4 * depth / fabs(dot3(ray->dir, surface->geometric));
    ray->zone = touching ? min_of(reach, (Reals)1024 * surface->back) : (Reals)0;
    ray->left = scene_numbers(scene, prim, touching);
    ray->left_side = surface->material * 2 + (inside & 1);
}

// The refracted ray at a surface. `eta` is the ratio of the indices of refraction, incident over
// transmitted side: it scales the part of dir along the surface. *total: total internal reflection.
// Where an interpolated normal would leave the ray on the side it came from, it is refracted about
// the geometric normal.
Ray refracted_ray(const Surface* surface, real3 dir, Reals eta, Indices prim, Mask* total) {
    real3 refracted;
    real3 normal = surface->normal;
    Reals arriving = dot3(dir, surface->geometric);
    for (int attempt = 0;; ++attempt) {
        Reals cosine = dot3(dir, normal);
        real3 along = add_scaled(dir, -cosine, normal);
        Reals sine = dot3(along, along);  // squared; 0 times an infinite eta^2 is 0
        Reals squared = (Reals)1 - (sine > (Reals)0 ? eta * eta * sine : (Reals)0);
        Reals depth = sqrt(squared);
        real3 bent = add_scaled(scale3(eta, along), cosine < (Reals)0 ? -depth : depth, normal);
        *total = !(squared >= (Reals)0);
        refracted = select3(eta == (Reals)1, dir, normalize3(bent));
        Mask passes = *total | (dot3(refracted, surface->geometric) * arriving > (Reals)0);
        if (!RT_HAS(VERTEX_NORMALS) || attempt == 1 || !any_lane(!passes)) break;
        normal = select3(passes, normal, surface->geometric);
    }
    // Among surfaces that touch it starts before them all, however grazing (note_crossed).
    real3 side = select3(surface->back > (Reals)0, negate3(dir), refracted);
    return spawn_ray(surface, offset_origin(surface, side), refracted, prim);
}

// Each live lane's ray, and its weight in the lane's color.
typedef struct {
    Ray ray;
    real3 throughput;
    Mask live;
    Index bounce;
} Path;

// Refracted rays pushed while the mirror rays of the same hits are followed. Bounces increase from
// entry to entry.
typedef struct {
    Path paths[RT_TREE_STACK];
    Index size;
} Pending;

Ray select_ray(Mask mask, Ray yes, Ray no) {
    Ray ray;
    ray.origin = select3(mask, yes.origin, no.origin);
    ray.dir = select3(mask, yes.dir, no.dir);
    ray.dir_low = select3(mask, yes.dir_low, no.dir_low);
    ray.origin_low = select3(mask, yes.origin_low, no.origin_low);
    ray.t_max = mask ? yes.t_max : no.t_max;
    ray.self_hit = mask ? yes.self_hit : no.self_hit;
    ray.from = mask ? yes.from : no.from;
    ray.zone = mask ? yes.zone : no.zone;
    ray.left = mask ? yes.left : no.left;
    ray.left_side = mask ? yes.left_side : no.left_side;
    return ray;
}

// Too dark to change a picture: below half an ulp of white.
Mask is_faint(real3 weight) {
    Reals largest = max_of(weight.x, max_of(weight.y, weight.z));
    return !(largest >= (Reals)(Real)RT_ROUNDOFF);
}

// Continues the path from a surface whose normal and geometric normal are already flipped for
// two_sided; `inside` where the ray came from behind it. Lanes whose paths end are switched off.
void scatter(const SceneView* scene, const Surface* surface, const Materials* material,
             Indices prim, Mask inside, Path* path, Pending* pending, PacketCounts* counts) {
    real3 throughput = path->throughput;
    real3 reflected = limit3(mul3(throughput, material->mirror));
    Mask glassy = RT_NO_LANES;
    if (RT_HAS(GLASS)) glassy = path->live & !is_black(material->transmission);
    // Where the point has moved, a chord no longer starts there; mirror rays outside meet none.
    Mask moved = (glassy | inside) & (surface->back > (Reals)0);
    moved &= surface->signed_diameter != (Reals)0;
    Indices from = moved ? (Indices)RT_NONE : prim;
    if (!RT_HAS(GLASS) || !any_lane(glassy)) {
        path->throughput = reflected;
        path->live &= !is_black(reflected);
        if (!any_lane(path->live)) return;
        path->ray = mirror_ray(surface, path->ray.dir, from);
        path->bounce += 1;
        counts->mirror += path->live & 1;
        RT_EXPLAIN(path->live, RT_EVENT_MIRROR, 0, path->bounce, (Reals)0, reflected,
                   path->ray.origin, path->ray.dir, reflected);
        return;
    }
    real3 transmitted = limit3(mul3(throughput, material->transmission));
    Mask total;
    Reals eta = inside ? material->ior : (Reals)1 / material->ior;
    Ray refracted = refracted_ray(surface, path->ray.dir, eta, prim, &total);
    if (any_lane(glassy & (surface->back > (Reals)0))) {
        note_crossed(scene, surface, path->ray.dir, inside, prim, &refracted);
        refracted.from = from;
    }
    total &= glassy;
    reflected = select3(total, limit3(add3(reflected, transmitted)), reflected);
    Mask transmits = glassy & !total & !is_faint(transmitted);
    Mask reflects = path->live & !is_black(reflected) & !(glassy & is_faint(reflected));
    Mask splits = reflects & transmits;
    path->bounce += 1;
    if (RT_HAS(MIRRORS) && any_lane(splits)) {
        Path later = {refracted, transmitted, splits, path->bounce};
        pending->paths[pending->size++] = later;
    }
    path->ray = select_ray(reflects, mirror_ray(surface, path->ray.dir, from), refracted);
    path->throughput = select3(reflects, reflected, transmitted);
    path->live = reflects | transmits;
    sign_lanes(scene, counts, glassy, (reflects & 1) + (transmits & 1) * 2);
    counts->mirror += reflects & 1;
    counts->transmitted += transmits & 1;
    RT_EXPLAIN(path->live, reflects ? RT_EVENT_MIRROR : RT_EVENT_REFRACTED, 0, path->bounce,
               (Reals)0, path->throughput, path->ray.origin, path->ray.dir, path->throughput);
}

// Adds the local light at a path's hits to the color, and continues the path.
real3 meet_surface(const SceneView* scene, const Hit* hit, real3 color, Path* path,
                   Pending* pending, PacketCounts* counts) {
    Surface surface = surface_at(scene, &path->ray, hit, path->live);
    Materials material = materials_of(scene, surface.material, path->live);
    Mask inside = dot3(surface.geometric, path->ray.dir) > (Reals)0;
    Mask turned = (material.two_sided != 0) & inside;
    surface.normal = select3(turned, negate3(surface.normal), surface.normal);
    surface.geometric = select3(turned, negate3(surface.geometric), surface.geometric);
    surface.signed_diameter = turned ? -surface.signed_diameter : surface.signed_diameter;
    sign_surfaces(scene, counts, path->live, hit->prim, inside);
    real3 to_eye = negate3(path->ray.dir);
    Surface lit = surface;
    Mask beyond = inside & !turned & (surface.back > (Reals)0);  // lit from the far side
    if (any_lane(beyond)) {
        real3 moved = add_scaled(surface.point, (Reals)2 * surface.back, path->ray.dir);
        lit.point = select3(beyond, moved, surface.point);
    }
    real3 local_light = shade(scene, &lit, &material, to_eye, hit->prim, path->live, counts);
    color = select3(path->live, add3(color, weigh3(path->throughput, local_light)), color);
    RT_EXPLAIN(path->live, RT_EVENT_HIT, hit->prim, path->bounce, hit->t, path->throughput,
               surface.point, surface.normal, local_light);
    bool ends = !(RT_HAS(MIRRORS) || RT_HAS(GLASS)) || path->bounce >= scene->params.max_bounces;
    if (ends) {
        path->live = RT_NO_LANES;
    } else {
        scatter(scene, &surface, &material, hit->prim, inside, path, pending, counts);
    }
    return color;
}

// Pops the ray pushed last. False when there is none.
bool resume(Path* path, Pending* pending) {
    if (!(RT_HAS(GLASS) && RT_HAS(MIRRORS)) || pending->size == 0) return false;
    pending->size -= 1;
    *path = pending->paths[pending->size];
    RT_EXPLAIN(path->live, RT_EVENT_REFRACTED, 0, path->bounce, (Reals)0, path->throughput,
               path->ray.origin, path->ray.dir, path->throughput);
    return true;
}

// The colors seen along the rays of the live lanes.
RT_OUT_OF_LINE real3 trace_path(const SceneView* scene, Ray ray, Mask live, PacketCounts* counts) {
    real3 color = make3((Reals)0, (Reals)0, (Reals)0);
    Path path = {ray, make3((Reals)1, (Reals)1, (Reals)1), live, 0};
    Pending pending;
    pending.size = 0;
    do {
        Hit hit = closest_hit(scene, &path.ray, path.live);
        Mask missed = path.live & (hit.prim == RT_NONE);
        if (any_lane(missed)) {
            real3 background = mul3(path.throughput, load3(scene->params.background));
            RT_EXPLAIN(missed, RT_EVENT_MISS, 0, path.bounce, (Reals)0, path.throughput,
                       path.ray.origin, path.ray.dir, load3(scene->params.background));
            color = select3(missed, add3(color, background), color);
            sign_lanes(scene, counts, missed, (Indices)RT_NONE);
            path.live &= !missed;
        }
        if (any_lane(path.live)) color = meet_surface(scene, &hit, color, &path, &pending, counts);
    } while (any_lane(path.live) || resume(&path, &pending));
    return color;
}

// The colors of samples k of the pixels (x, y) in the live lanes.
real3 trace_sample(const SceneView* scene, Indices x, Indices y, Indices k, Mask live,
                   PacketCounts* counts) {
    Ray ray = camera_ray(&scene->params, x, y, k);
    RT_EXPLAIN(live, RT_EVENT_SAMPLE, k, 0, (Reals)0, ray.dir, ray.origin, ray.dir, ray.dir);
    return trace_path(scene, ray, live, counts);
}

#endif
