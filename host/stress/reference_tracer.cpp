// SPDX-License-Identifier: Apache-2.0
#include "host/stress/reference_tracer.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <type_traits>
#include <vector>

#include "host/stress/wide_real.h"

namespace rt {

namespace {

using stress::Quad;
using stress::Wide3;
using stress::widened;

template <typename R>
struct Ball {
    Wide3<R> center;
    R radius;
    int material;
};

template <typename R>
struct Face {
    Wide3<R> corner, edge1, edge2;
    Wide3<R> normal;  // unit
    std::optional<std::array<Wide3<R>, 3>> normals;
    int material;
};

template <typename R>
struct Lamp {
    Wide3<R> position, intensity;
};

/// A ray that may start on primitive `from` (or -1). Hits nearer than `least` are that start.
template <typename R>
struct WideRay {
    Wide3<R> origin, dir;
    int from = -1;
    R least = 0;
};

template <typename R>
struct WideHit {
    R t = -1, u = 0, v = 0;
    int prim = -1;
};

template <typename R>
struct WideSurface {
    Wide3<R> point, normal, geometric;
    const Scene::Material* material;
};

/// Surfaces this near to each other, relative to the distance, are one. Below what a double
/// coordinate can say, far above the rounding of either wide type.
template <typename R>
constexpr R same_distance = R(1e-12);

/// How far beyond its edges a triangle reaches, so that rounding opens no gap between neighbours.
template <typename R>
constexpr R rim = std::is_same_v<R, Quad> ? R(1e-28) : R(1e-16);

template <typename R>
class Tracer final : public ReferenceTracer {
   public:
    explicit Tracer(const Scene& scene) : scene_(scene) {
        for (const auto& sphere : scene.spheres) {
            balls_.push_back({widened<R>(sphere.center), R(sphere.radius), sphere.material});
        }
        for (const auto& triangle : scene.triangles) faces_.push_back(make_face(triangle));
        for (const auto& light : scene.lights) {
            lamps_.push_back({widened<R>(light.position), widened<R>(light.intensity)});
        }
        set_camera();
        eye_ball_ = ball_at_eye();
    }

    std::array<double, 3> colour_at(double x, double y, double dx, double dy) const override {
        const Wide3<R> colour = trace(eye_ray(R(x) + R(dx), R(y) + R(dy)));
        return {static_cast<double>(colour.x), static_cast<double>(colour.y),
                static_cast<double>(colour.z)};
    }

   private:
    static Face<R> make_face(const Scene::Triangle& triangle) {
        Face<R> face;
        face.corner = widened<R>(triangle.vertices[0]);
        face.edge1 = widened<R>(triangle.vertices[1]) - face.corner;
        face.edge2 = widened<R>(triangle.vertices[2]) - face.corner;
        face.normal = unit(cross(face.edge1, face.edge2));
        if (triangle.normals) {
            const auto& n = *triangle.normals;
            face.normals = {widened<R>(n[0]), widened<R>(n[1]), widened<R>(n[2])};
        }
        face.material = triangle.material;
        return face;
    }

    /// The window's sides; a field of view gives square pixels.
    void set_camera() {
        using Fixed = Scene::FieldOfView::Fixed;
        const Scene::Camera& camera = scene_.camera;
        forward_ = unit(widened<R>(camera.at) - widened<R>(camera.from));
        right_ = unit(cross(forward_, widened<R>(camera.up)));
        up_ = cross(right_, forward_);
        const R width = scene_.width, height = scene_.height;
        const double amount = camera.field_of_view.amount;
        const long double angle = amount * (std::numbers::pi_v<long double> / 360);
        const R half_angle = std::tan(angle);
        const auto span = [&](R half_width, R half_height) {
            left_ = -half_width, right_side_ = half_width;
            bottom_ = -half_height, top_ = half_height;
        };
        switch (camera.field_of_view.fixed) {
            case Fixed::window:
                left_ = camera.window.left, right_side_ = camera.window.right;
                bottom_ = camera.window.bottom, top_ = camera.window.top;
                return;
            case Fixed::horizontal:
                return span(half_angle, half_angle * height / width);
            case Fixed::vertical:
                return span(half_angle * width / height, half_angle);
            case Fixed::view_width:
                return span(R(amount) / 2, R(amount) / 2 * height / width);
            case Fixed::view_height:
                return span(R(amount) / 2 * width / height, R(amount) / 2);
        }
    }

    /// The ball whose surface the eye lies on, to a double's last bits, or -1. Its rays leave it.
    int ball_at_eye() const {
        for (std::size_t i = 0; i < balls_.size(); ++i) {
            const Wide3<R> f = widened<R>(scene_.camera.from) - balls_[i].center;
            const R squared = balls_[i].radius * balls_[i].radius;
            if (stress::magnitude(dot(f, f) - squared) <= R(1e-14) * squared) {
                return static_cast<int>(i);
            }
        }
        return -1;
    }

    WideRay<R> eye_ray(R x, R y) const {
        const R across = left_ + (right_side_ - left_) * x / R(scene_.width);
        const R upwards = top_ - (top_ - bottom_) * y / R(scene_.height);
        const Wide3<R> offset = across * right_ + upwards * up_;
        const Wide3<R> from = widened<R>(scene_.camera.from);
        if (scene_.camera.projection == Scene::Projection::orthographic) {
            return {from + offset, forward_};
        }
        return {from, unit(forward_ + offset), eye_ball_};
    }

    R hit_ball(const WideRay<R>& ray, const Ball<R>& ball, bool leaving) const {
        const Wide3<R> f = ray.origin - ball.center;
        const R b = dot(f, ray.dir);
        if (leaving) return -2 * b;
        const R discriminant = b * b - (dot(f, f) - ball.radius * ball.radius);
        if (!(discriminant >= 0)) return -1;
        const R root = stress::square_root(discriminant);
        return -b - root > ray.least ? -b - root : -b + root;
    }

    /// Moller and Trumbore's.
    R hit_face(const WideRay<R>& ray, const Face<R>& face, R& u, R& v) const {
        const Wide3<R> p = cross(ray.dir, face.edge2);
        const R determinant = dot(face.edge1, p);
        if (determinant == 0) return -1;
        const Wide3<R> s = ray.origin - face.corner;
        u = dot(s, p) / determinant;
        if (!(u >= -rim<R> && u <= 1 + rim<R>)) return -1;
        const Wide3<R> q = cross(s, face.edge1);
        v = dot(ray.dir, q) / determinant;
        if (!(v >= -rim<R> && u + v <= 1 + rim<R>)) return -1;
        return dot(face.edge2, q) / determinant;
    }

    WideHit<R> hit_primitive(const WideRay<R>& ray, int prim) const {
        WideHit<R> hit;
        const int ball_count = static_cast<int>(balls_.size());
        if (prim < ball_count) {
            hit.t = hit_ball(ray, balls_[static_cast<std::size_t>(prim)], prim == ray.from);
        } else if (prim != ray.from) {
            const auto index = static_cast<std::size_t>(prim - ball_count);
            hit.t = hit_face(ray, faces_[index], hit.u, hit.v);
        }
        if (hit.t > ray.least) hit.prim = prim;
        return hit;
    }

    int primitives() const { return static_cast<int>(balls_.size() + faces_.size()); }

    WideHit<R> nearest(const WideRay<R>& ray) const {
        WideHit<R> best;
        for (int prim = 0; prim < primitives(); ++prim) {
            const WideHit<R> hit = hit_primitive(ray, prim);
            if (hit.prim < 0) continue;
            if (best.prim < 0 || hit.t < best.t * (1 - same_distance<R>)) best = hit;
        }
        return best;
    }

    bool blocked(const WideRay<R>& ray, R distance) const {
        for (int prim = 0; prim < primitives(); ++prim) {
            const WideHit<R> hit = hit_primitive(ray, prim);
            if (hit.prim >= 0 && hit.t < distance * (1 - same_distance<R>)) return true;
        }
        return false;
    }

    const Scene::Material& material_of(int index) const {
        return scene_.materials[static_cast<std::size_t>(index)];
    }

    WideSurface<R> ball_surface(const WideRay<R>& ray, const WideHit<R>& hit) const {
        const Ball<R>& ball = balls_[static_cast<std::size_t>(hit.prim)];
        const Wide3<R> normal = unit(ray.origin - ball.center + hit.t * ray.dir);
        return {ball.center + ball.radius * normal, normal, normal, &material_of(ball.material)};
    }

    WideSurface<R> face_surface(const WideHit<R>& hit) const {
        const Face<R>& face = faces_[static_cast<std::size_t>(hit.prim) - balls_.size()];
        const Wide3<R> point = face.corner + hit.u * face.edge1 + hit.v * face.edge2;
        WideSurface<R> surface{point, face.normal, face.normal, &material_of(face.material)};
        if (!face.normals) return surface;
        const auto& n = *face.normals;
        const Wide3<R> blend = (1 - hit.u - hit.v) * n[0] + hit.u * n[1] + hit.v * n[2];
        if (dot(blend, blend) > R(1e-12)) surface.normal = unit(blend);
        if (dot(surface.normal, face.normal) < 0) surface.geometric = -face.normal;
        return surface;
    }

    WideSurface<R> surface_of(const WideRay<R>& ray, const WideHit<R>& hit) const {
        WideSurface<R> surface = static_cast<std::size_t>(hit.prim) < balls_.size()
                                     ? ball_surface(ray, hit)
                                     : face_surface(hit);
        if (surface.material->two_sided && dot(surface.geometric, ray.dir) > 0) {
            surface.normal = -surface.normal;
            surface.geometric = -surface.geometric;
        }
        return surface;
    }

    static R lobe(const Wide3<R>& normal, const Wide3<R>& half_vector, double exponent) {
        if (exponent == 0) return 1;
        const R cosine = dot(normal, half_vector);
        if (!(cosine > 0)) return 0;
        const auto gap = static_cast<long double>(1 - cosine);
        const long double log_cosine = gap < 0.5L ? std::log1p(-gap) : std::log(1 - gap);
        return std::exp(exponent * log_cosine);
    }

    Wide3<R> lit_by(const Lamp<R>& lamp, const WideSurface<R>& surface, const Wide3<R>& to_eye,
                    const WideRay<R>& shadow_start) const {
        const Wide3<R> way = lamp.position - surface.point;
        if (!(dot(surface.geometric, way) > 0)) return {};
        const R distance = length(way);
        WideRay<R> shadow = shadow_start;
        shadow.dir = (R(1) / distance) * way;
        const R cosine = dot(surface.normal, shadow.dir);
        if (!(cosine > 0) || blocked(shadow, distance)) return {};
        const Scene::Material& material = *surface.material;
        const Wide3<R> sum = shadow.dir + to_eye;
        Wide3<R> reflected = cosine * widened<R>(material.diffuse);
        if (dot(sum, sum) > 0) {
            reflected = reflected + lobe(surface.normal, unit(sum), material.shininess) *
                                        widened<R>(material.specular);
        }
        return lamp.intensity * reflected;
    }

    static Wide3<R> mirrored(const Wide3<R>& dir, const WideSurface<R>& surface) {
        const auto about = [&](const Wide3<R>& normal) {
            return dir - (2 * dot(dir, normal)) * normal;
        };
        const Wide3<R> out = about(surface.normal);
        const bool leaves = dot(out, surface.geometric) * dot(dir, surface.geometric) < 0;
        return unit(leaves ? out : about(surface.geometric));
    }

    /// Mirrors that brighten at each bounce stay finite, far above all that can be seen.
    static Wide3<R> saturated(const Wide3<R>& share) {
        const R most = 1e300;
        const auto cut = [&](R value) { return value < most ? value : most; };
        return {cut(share.x), cut(share.y), cut(share.z)};
    }

    Wide3<R> trace(WideRay<R> ray) const {
        Wide3<R> colour, share{1, 1, 1};
        for (int bounce = 0;; ++bounce) {
            const WideHit<R> hit = nearest(ray);
            if (hit.prim < 0) return colour + share * widened<R>(scene_.background);
            const WideSurface<R> surface = surface_of(ray, hit);
            const Scene::Material& material = *surface.material;
            WideRay<R> next{surface.point, {}, hit.prim, same_distance<R> / 16 * hit.t};
            Wide3<R> here = widened<R>(material.ambient) * widened<R>(scene_.ambient_light);
            for (const Lamp<R>& lamp : lamps_) {
                here = here + lit_by(lamp, surface, -ray.dir, next);
            }
            colour = colour + share * here;
            share = saturated(share * widened<R>(material.mirror));
            if (bounce >= scene_.max_bounces || dot(share, share) == 0) return colour;
            next.dir = mirrored(ray.dir, surface);
            ray = next;
        }
    }

    const Scene scene_;
    std::vector<Ball<R>> balls_;
    std::vector<Face<R>> faces_;
    std::vector<Lamp<R>> lamps_;
    Wide3<R> forward_, right_, up_;
    int eye_ball_ = -1;
    R left_ = -1, right_side_ = 1, bottom_ = -1, top_ = 1;
};

}  // namespace

std::unique_ptr<ReferenceTracer> make_reference_tracer(const Scene& scene, ReferenceKind kind) {
    if (kind == ReferenceKind::extended) return std::make_unique<Tracer<long double>>(scene);
    return std::make_unique<Tracer<Quad>>(scene);
}

}  // namespace rt
