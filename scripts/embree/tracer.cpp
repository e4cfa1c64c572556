// SPDX-License-Identifier: Apache-2.0
#include "scripts/embree/tracer.h"

#include <xmmintrin.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <thread>

#include "host/render/tile_rounds.h"
#include "scripts/embree/lanes.h"

namespace embree_bench {

namespace {

using FlatScene = rt::FlatScene<float>;

#ifdef __AVX512F__
using RayPacket = RTCRay16;
using RayHitPacket = RTCRayHit16;
constexpr auto intersect = rtcIntersect16;
constexpr auto occluded = rtcOccluded16;
#else
using RayPacket = RTCRay8;
using RayHitPacket = RTCRayHit8;
constexpr auto intersect = rtcIntersect8;
constexpr auto occluded = rtcOccluded8;
#endif

constexpr int tile_side = 32;
constexpr float infinity = std::numeric_limits<float>::infinity();

/// How far secondary rays start off their surfaces, in parts of the coordinates: Embree's hits are
/// not as near the surface as mirrorball's, and it cannot leave a primitive out.
constexpr float offset_scale = 0x1p-19f;
constexpr float light_end = 1 - 16 * 0x1p-24f;

struct Rays {
    Vec3 origin, dir;
    Reals t_max;
};

struct Hits {
    Reals t;
    Vec3 normal;  ///< of any length
    Ints geometry, primitive;
    Ints found;
};

template <typename Ray>
void fill(Ray& ray, const Rays& rays) {
    stored(rays.origin.x, ray.org_x);
    stored(rays.origin.y, ray.org_y);
    stored(rays.origin.z, ray.org_z);
    stored(rays.dir.x, ray.dir_x);
    stored(rays.dir.y, ray.dir_y);
    stored(rays.dir.z, ray.dir_z);
    stored(rays.t_max, ray.tfar);
    stored(Reals{}, ray.tnear);
    stored(Reals{}, ray.time);
    stored(ints(-1), ray.mask);
    stored(Ints{}, ray.flags);
}

/// Embree's answers for packets.
class Asker {
   public:
    Asker(RTCScene scene, MirrorRays mirror_rays) : scene_(scene) {
        rtcInitIntersectContext(&coherent_);
        rtcInitIntersectContext(&mirrors_);
        coherent_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        mirrors_.flags = mirror_rays == MirrorRays::coherent
                             ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                             : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    }

    Hits nearest(Ints live, const Rays& rays, bool after_mirror) {
        alignas(64) std::int32_t valid[lanes];
        RayHitPacket query;
        fill(query.ray, rays);
        stored(ints(-1), query.hit.geomID);
        stored(ints(-1), query.hit.instID[0]);
        stored(live, valid);
        intersect(valid, scene_, context_of(after_mirror), &query);
        Hits hits;
        hits.t = loaded<Reals>(query.ray.tfar);
        hits.normal = {loaded<Reals>(query.hit.Ng_x), loaded<Reals>(query.hit.Ng_y),
                       loaded<Reals>(query.hit.Ng_z)};
        hits.geometry = loaded<Ints>(query.hit.geomID);
        hits.primitive = loaded<Ints>(query.hit.primID);
        hits.found = live & (hits.geometry != -1);
        return hits;
    }

    Ints blocked(Ints live, const Rays& rays, bool after_mirror) {
        alignas(64) std::int32_t valid[lanes];
        RayPacket query;
        fill(query, rays);
        stored(live, valid);
        occluded(valid, scene_, context_of(after_mirror), &query);
        return live & (loaded<Reals>(query.tfar) < 0.0f);
    }

   private:
    RTCIntersectContext* context_of(bool after_mirror) {
        return after_mirror ? &mirrors_ : &coherent_;
    }

    RTCScene scene_;
    RTCIntersectContext coherent_, mirrors_;
};

/// The materials of a packet's surfaces.
struct Materials {
    Vec3 ambient{}, diffuse{}, specular{}, mirror{};
    Reals shininess{};
    Ints two_sided{};
};

struct Surface {
    Vec3 point, normal;
    Reals offset;
    Materials material;
};

class PacketTracer {
   public:
    PacketTracer(const FlatScene& flat, const EmbreeScene& embree, MirrorRays mirror_rays)
        : flat_(flat), materials_(embree.materials().data()), asker_(embree.handle(), mirror_rays) {
        first_triangle_ = static_cast<std::int32_t>(flat.spheres.size());
    }

    RayCounts rays;

    Rays eye_rays(Reals x, Reals y) const {
        const auto& params = flat_.params;
        const Reals sx = 2.0f * x - static_cast<float>(params.width);
        const Reals sy = 2.0f * y - static_cast<float>(params.height);
        Rays eye;
        eye.origin = sx * all(params.origin_dx) + sy * all(params.origin_dy);
        eye.dir = normalized(all(params.direction) + sx * all(params.direction_dx) +
                             sy * all(params.direction_dy));
        eye.t_max = reals(infinity);
        return eye;
    }

    Vec3 color_of(Rays packet, Ints live) {
        Vec3 color{};
        Vec3 throughput{reals(1), reals(1), reals(1)};
        for (int bounce = 0;; ++bounce) {
            const Hits hits = asker_.nearest(live, packet, bounce > 0);
            const Ints missed = live & ~hits.found;
            if (any(missed)) {
                color = select(missed, color + throughput * all(flat_.params.background), color);
                live = hits.found;
                if (!any(live)) return color;
            }
            const Surface surface = surface_at(packet, hits, live);
            const Vec3 light = shade(surface, -packet.dir, live, bounce > 0);
            color = select(live, color + throughput * light, color);
            if (!flat_.features[rt::feature::mirrors] || bounce >= flat_.params.max_bounces)
                return color;
            throughput = throughput * surface.material.mirror;
            live &= ~is_black(throughput);
            if (!any(live)) return color;
            packet = mirror_rays(surface, packet.dir);
            rays.mirror += static_cast<std::uint64_t>(count(live));
        }
    }

   private:
    /// The materials of the live lanes, one after the other for all lanes that wear it.
    Materials materials_of(const Hits& hits, Ints live) const {
        const Ints is_triangle = hits.geometry == EmbreeScene::triangles;
        const Ints place = hits.primitive + (is_triangle ? ints(first_triangle_) : Ints{});
        const Ints index = gathered(materials_, live ? place : Ints{});
        Materials material;
        for (Ints left = live; any(left);) {
            const std::int32_t one = index[__builtin_ctz(lane_bits(left))];
            const Ints worn = left & (index == one);
            left &= ~worn;
            const auto& flat = flat_.materials[static_cast<std::size_t>(one)];
            material.ambient = select(worn, all(flat.ambient), material.ambient);
            material.diffuse = select(worn, all(flat.diffuse), material.diffuse);
            material.specular = select(worn, all(flat.specular), material.specular);
            material.mirror = select(worn, all(flat.mirror), material.mirror);
            material.shininess = worn ? reals(flat.shininess) : material.shininess;
            material.two_sided = worn ? ints(flat.two_sided) : material.two_sided;
        }
        return material;
    }

    Surface surface_at(const Rays& packet, const Hits& hits, Ints live) const {
        Surface surface;
        surface.material = materials_of(hits, live);
        surface.normal = normalized(hits.normal);
        const Ints turned =
            (surface.material.two_sided != 0) & (dot(surface.normal, packet.dir) > 0.0f);
        surface.normal = select(turned, -surface.normal, surface.normal);
        const Vec3& o = packet.origin;
        const Reals size = larger(magnitude(o.x), larger(magnitude(o.y), magnitude(o.z)));
        surface.offset = offset_scale * (size + hits.t);
        surface.point = o + (hits.t - surface.offset) * packet.dir;
        return surface;
    }

    static Rays mirror_rays(const Surface& surface, const Vec3& dir) {
        Rays mirror;
        mirror.dir = normalized(dir + (-2.0f * dot(dir, surface.normal)) * surface.normal);
        const Ints behind = dot(surface.normal, mirror.dir) < 0.0f;
        mirror.origin =
            surface.point + (behind ? -surface.offset : surface.offset) * surface.normal;
        mirror.t_max = reals(infinity);
        return mirror;
    }

    Vec3 shade(const Surface& surface, const Vec3& to_eye, Ints live, bool after_mirror) {
        Vec3 color = surface.material.ambient * all(flat_.params.ambient_light);
        const Vec3 origin = surface.point + surface.offset * surface.normal;
        for (const auto& light : flat_.lights) {
            color = color + light_contribution(surface, light, origin, to_eye, live, after_mirror);
        }
        return color;
    }

    Vec3 light_contribution(const Surface& surface, const rt::Flat<float>::Light& light,
                            const Vec3& origin, const Vec3& to_eye, Ints live, bool after_mirror) {
        const Vec3 to_light = all(light.position) - origin;
        Ints lit = live & (dot(surface.normal, to_light) > 0.0f);
        if (!any(lit)) return Vec3{reals(0), reals(0), reals(0)};
        const Reals distance = root(dot(to_light, to_light));
        Rays shadow;
        shadow.origin = origin;
        shadow.dir = (1.0f / distance) * to_light;
        const Reals cosine = dot(surface.normal, shadow.dir);
        lit &= cosine > 0.0f;
        if (!any(lit)) return Vec3{reals(0), reals(0), reals(0)};
        shadow.t_max = distance * light_end;
        rays.shadow += bits(lit);
        lit &= ~asker_.blocked(lit, shadow, after_mirror);
        if (!any(lit)) return Vec3{reals(0), reals(0), reals(0)};
        Vec3 reflected = cosine * surface.material.diffuse;
        const Ints shiny = lit & ~is_black(surface.material.specular);
        if (any(shiny)) {
            const Reals lobe = specular_lobe(surface, shadow.dir, to_eye);
            reflected = select(shiny, reflected + lobe * surface.material.specular, reflected);
        }
        return select(lit, all(light.intensity) * reflected, Vec3{});
    }

    static Reals specular_lobe(const Surface& surface, const Vec3& to_light, const Vec3& to_eye) {
        const Vec3 sum = to_light + to_eye;
        const Reals along = dot(surface.normal, sum);
        const Vec3 across = sum - along * surface.normal;
        return blinn_lobe(along, dot(across, across), dot(sum, sum), surface.material.shininess);
    }

    static std::uint64_t bits(Ints mask) { return static_cast<std::uint64_t>(count(mask)); }

    const FlatScene& flat_;
    const std::int32_t* materials_;
    std::int32_t first_triangle_;
    Asker asker_;
};

/// One thread's share of the picture, in packets of 2x2 pixels x 4 samples where there are four.
class TileRenderer {
   public:
    TileRenderer(const FlatScene& flat, PacketTracer& tracer, std::vector<float>& rgb)
        : params_(flat.params),
          tracer_(tracer),
          rgb_(rgb),
          shape_(rt::packet_shape(lanes, static_cast<int>(flat.params.samples))) {
        for (int i = 0; i < lanes; ++i) {
            const int pixel = i % shape_.pixels();
            column_[i] = pixel % shape_.width;
            row_[i] = pixel / shape_.width;
            sample_[i] = i / shape_.pixels();
        }
    }

    void render(int left, int top) {
        for (int row = top; row < std::min(top + tile_side, params_.height); row += shape_.height) {
            for (int column = left; column < std::min(left + tile_side, params_.width);
                 column += shape_.width) {
                render_packet(column, row);
            }
        }
    }

   private:
    void render_packet(int left, int top) {
        const Ints column = column_ + left, row = row_ + top;
        const Ints live = (column < params_.width) & (row < params_.height);
        const Reals x = to_reals(column), y = to_reals(params_.height - 1 - row);
        const float side = static_cast<float>(params_.grid);
        float sum[3][lanes] = {};
        for (int first = 0; first < params_.samples; first += shape_.samples) {
            const Ints k = sample_ + first;
            const Reals dx = (to_reals(k % params_.grid) + 0.5f) / side;
            const Reals dy = (to_reals(k / params_.grid) + 0.5f) / side;
            const Vec3 color = tracer_.color_of(tracer_.eye_rays(x + dx, y + dy), live);
            tracer_.rays.primary += static_cast<std::uint64_t>(count(live));
            add(color.x, sum[0]);
            add(color.y, sum[1]);
            add(color.z, sum[2]);
        }
        for (int pixel = 0; pixel < shape_.pixels(); ++pixel) {
            if (live[pixel] == 0) continue;
            const std::size_t at = 3 * (static_cast<std::size_t>(row[pixel]) *
                                            static_cast<std::size_t>(params_.width) +
                                        static_cast<std::size_t>(column[pixel]));
            for (std::size_t c = 0; c < 3; ++c) {
                rgb_[at + c] = sum[c][pixel] / static_cast<float>(params_.samples);
            }
        }
    }

    /// Adds the samples of each pixel.
    void add(Reals v, float* sum) const {
        alignas(64) float values[lanes];
        stored(v, values);
        for (int k = 0; k < shape_.samples; ++k) {
            for (int pixel = 0; pixel < shape_.pixels(); ++pixel) {
                sum[pixel] += values[k * shape_.pixels() + pixel];
            }
        }
    }

    const rt::Flat<float>::LaunchParams params_;
    PacketTracer& tracer_;
    std::vector<float>& rgb_;
    const rt::PacketShape shape_;
    Ints column_, row_, sample_;
};

}  // namespace

RayCounts& RayCounts::operator+=(const RayCounts& other) {
    primary += other.primary;
    shadow += other.shadow;
    mirror += other.mirror;
    return *this;
}

TracedPicture trace(const FlatScene& flat, const EmbreeScene& embree, MirrorRays mirror_rays,
                    int threads) {
    TracedPicture picture;
    const int across = (flat.params.width + tile_side - 1) / tile_side;
    const int down = (flat.params.height + tile_side - 1) / tile_side;
    picture.rgb.assign(3 * static_cast<std::size_t>(flat.params.width) *
                           static_cast<std::size_t>(flat.params.height),
                       0.0f);
    std::vector<RayCounts> rays(static_cast<std::size_t>(threads));
    std::atomic<int> next = 0;
    const auto run = [&](std::size_t number) {
        _mm_setcsr(_mm_getcsr() | 0x8040);  // flush subnormals, as Embree advises
        PacketTracer tracer(flat, embree, mirror_rays);
        TileRenderer renderer(flat, tracer, picture.rgb);
        for (int tile = next++; tile < across * down; tile = next++) {
            renderer.render(tile % across * tile_side, tile / across * tile_side);
        }
        rays[number] = tracer.rays;
    };
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::thread> pool;
    for (std::size_t i = 0; i < rays.size(); ++i) pool.emplace_back(run, i);
    for (std::thread& thread : pool) thread.join();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    picture.seconds = taken.count();
    for (const RayCounts& counts : rays) picture.rays += counts;
    return picture;
}

}  // namespace embree_bench
