// SPDX-License-Identifier: Apache-2.0
//
// The probes of functions that take a scene: each holds much of the tracer and takes long to
// compile.
#define PROBE_SCENE RT_SCENE_ARRAYS(RT_SCENE_PASSED) __global const LaunchParams* params
#define PROBE_SCENE_PACKET \
    PROBE_PACKET;          \
    SceneView scene = {RT_SCENE_ARRAYS(RT_SCENE_NAME) * params}

// The materials of the surfaces of a probe's scene.
Materials probe_materials(const SceneView* scene, const Surface* surface) {
    return materials_of(scene, surface->material, RT_ALL_LANES);
}

__kernel void probe_closest_hit(PROBE_ITEMS, PROBE_SCENE, __global const ProbeRay* rays,
                                __global ProbeHit* out) {
    PROBE_SCENE_PACKET;
    Ray ray = RAYS(rays);
    PUT_HIT(out, closest_hit(&scene, &ray, RT_ALL_LANES));
}

// Towards light 0.
__kernel void probe_any_hit(PROBE_ITEMS, PROBE_SCENE, __global const ProbeRay* rays,
                            __global Index* out) {
    PROBE_SCENE_PACKET;
    Ray ray = RAYS(rays);
    PUT_MASK(out, any_hit(&scene, &ray, RT_TOUCHES_FIRST_LIGHT, 0, params->triangle_count));
}

__kernel void probe_primitive_surface(PROBE_ITEMS, PROBE_SCENE, __global const ProbeRay* rays,
                                      __global const ProbeHit* hits, __global ProbeSurface* out) {
    PROBE_SCENE_PACKET;
    Ray ray = RAYS(rays);
    Hit hit = HITS(hits);
    Surface surface = no_surface();
    PROBE_EACH_LANE {
        Surface met = primitive_surface(&scene, &ray, &hit, hits[THIS_ITEM].prim);
        surface = select_surface(THIS_LANE, met, surface);
    }
    PUT_SURFACE(out, surface);
}

__kernel void probe_is_on_edge(PROBE_ITEMS, PROBE_SCENE, __global const ProbeHit* hits,
                               __global Index* out) {
    PROBE_SCENE_PACKET;
    Hit hit = HITS(hits);
    PUT_MASK(out, is_on_edge(&scene, &hit));
}

__kernel void probe_surface_at(PROBE_ITEMS, PROBE_SCENE, __global const ProbeRay* rays,
                               __global const ProbeHit* hits, __global ProbeSurface* out) {
    PROBE_SCENE_PACKET;
    Ray ray = RAYS(rays);
    Hit hit = HITS(hits);
    PUT_SURFACE(out, surface_at(&scene, &ray, &hit, RT_ALL_LANES));
}

// Light 0 of the scene; the surface gives the material and, if it is on one, the primitive.
__kernel void probe_light_contribution(PROBE_ITEMS, PROBE_SCENE,
                                       __global const ProbeSurface* surfaces,
                                       __global const Packed3* origins,
                                       __global const Packed3* to_eye, __global const Index* prims,
                                       __global Packed3* out, __global RayCounts* counts) {
    PROBE_SCENE_PACKET;
    Surface surface = SURFACES(surfaces);
    Materials material = probe_materials(&scene, &surface);
    PacketCounts used = no_counts();
    PUT_REAL3(out, light_contribution(&scene, &surface, &material, 0, REAL3(origins), REAL3(to_eye),
                                      INDICES(prims), RT_ALL_LANES, &used));
    PUT_COUNTS(counts, used);
}

__kernel void probe_shade(PROBE_ITEMS, PROBE_SCENE, __global const ProbeSurface* surfaces,
                          __global const Packed3* to_eye, __global const Index* prims,
                          __global Packed3* out, __global RayCounts* counts) {
    PROBE_SCENE_PACKET;
    Surface surface = SURFACES(surfaces);
    Materials material = probe_materials(&scene, &surface);
    PacketCounts used = no_counts();
    PUT_REAL3(out, shade(&scene, &surface, &material, REAL3(to_eye), INDICES(prims), RT_ALL_LANES,
                         &used));
    PUT_COUNTS(counts, used);
}

__kernel void probe_trace_path(PROBE_ITEMS, PROBE_SCENE, __global const ProbeRay* rays,
                               __global Packed3* out, __global RayCounts* counts) {
    PROBE_SCENE_PACKET;
    PacketCounts used = no_counts();
    PUT_REAL3(out, trace_path(&scene, RAYS(rays), RT_ALL_LANES, &used));
    PUT_COUNTS(counts, used);
}

__kernel void probe_trace_sample(PROBE_ITEMS, PROBE_SCENE, __global const Index* x,
                                 __global const Index* y, __global const Index* k,
                                 __global Packed3* out, __global RayCounts* counts) {
    PROBE_SCENE_PACKET;
    PacketCounts used = no_counts();
    PUT_REAL3(out, trace_sample(&scene, INDICES(x), INDICES(y), INDICES(k), RT_ALL_LANES, &used));
    PUT_COUNTS(counts, used);
}

// Pixels anywhere, as many at a time as a packet holds.
__kernel void probe_trace_pixel(PROBE_ITEMS, PROBE_SCENE, __global const Index* x,
                                __global const Index* y, __global Packed3* out) {
    PROBE_SCENE_PACKET;
    Packet packet = make_packet(params->samples, RT_SAMPLES_TOGETHER);
    for (Index done = 0; done < RT_LANES; done += packet.pixels) {
        IndexLanes pixel, column, row;
        pixel.all = packet.pixel + done;
        PROBE_EACH_LANE {
            size_t i = lane_item(at, count, pixel.lane[lane]);
            column.lane[lane] = x[i];
            row.lane[lane] = y[i];
        }
        RayCounts counts = {0, 0, 0, 0};
        real3 colors = trace_pixels(&scene, &packet, column.all, row.all, RT_ALL_LANES, &counts);
        Indices places = packet.pixel + (done + (Index)at);
        places = places < (Indices)(Index)count ? places : (Indices)-1;
        store_lanes((__global Real*)out, colors, places, packet.pixels);
    }
}
