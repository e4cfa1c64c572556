// SPDX-License-Identifier: Apache-2.0
//
// The structs and limits that the host and the kernels share. Included by OpenCL C once per program
// and by C++ twice (host/flatten/flat_types.h). The includer must first define
//   RT_REAL   float or double
//   RT_INDEX  int or long, the integer as wide as RT_REAL
//   RT_COUNT  an unsigned 64-bit integer
// so that every struct consists of rows of four equally wide numbers: a packed 3-vector and a named
// scalar. No float3 here (16 bytes in OpenCL, 12 in GLM) and no data hidden in a fourth component.
// Positions are in the renderer's frame: the eye is the origin and the scene has been scaled by a
// power of two (host/flatten). This header includes nothing and has no include guard on purpose.

typedef RT_REAL Real;
typedef RT_INDEX Index;

typedef struct {
    Real x, y, z;
} Packed3;

typedef struct {
    Packed3 center;
    Real radius;
    Index material;
    Index is_huge;       // far larger than its distance: kernels/intersect.cl
    Real power;          // of the eye's position: |center|^2 - radius^2, computed in double
    Index touches;       // RT_TOUCHES_...
    Packed3 center_low;  // part of center lost to rounding
    Index pad;
} Sphere;

// The side of a cone's frustum, open at both ends; a cylinder where the slope is 0.
typedef struct {
    Packed3 base;
    Real base_radius;
    Packed3 axis;  // unit, from the base to the other rim
    Real length;
    Real slope;  // change in radius per unit length along the axis
    Index material;
    Index touches;  // RT_TOUCHES_...
    Real apex_radius;
} Cone;

typedef struct {
    Packed3 p0;
    Index material;
    Packed3 p1;
    Index smooth;  // index into the vertex normals, or RT_NONE for a flat triangle
    Packed3 p2;
    Real offset;     // bound on how far a barycentric hit point lies off the plane
    Packed3 normal;  // unit, computed in double from the unrounded vertices
    Real plane;      // signed distance of the plane from the eye: dot(normal, p0); likewise
} Triangle;

typedef struct {
    Packed3 n0;
    Real pad0;
    Packed3 n1;
    Real pad1;
    Packed3 n2;
    Real pad2;
} VertexNormals;

typedef struct {
    Packed3 ambient;
    Real shininess;
    Packed3 diffuse;
    Index two_sided;
    Packed3 specular;
    Real ior;  // index of refraction behind the surface
    Packed3 mirror;
    Real pad0;
    Packed3 transmission;
    Real pad1;
} Material;

typedef struct {
    Packed3 position;
    Index first_caster;  // index in the caster list of its first triangle
    Packed3 intensity;
    Index caster_count;
} Light;

// A node of a bounding volume hierarchy over one kind of primitive. A leaf holds `count` primitives
// (at least 1), starting at `first`; an inner node (count 0) has the children first and first + 1.
// Roots have odd indices and pairs of children start at even ones, so that a pair fills a cache
// line. Node 0 means none.
typedef struct {
    Packed3 low;
    Index first;
    Packed3 high;
    Index count;
} BvhNode;

// Constant for a whole picture. A sample at (x, y) pixels from the lower left corner starts at
// sx * origin_dx + sy * origin_dy and goes along direction + sx * direction_dx + sy * direction_dy,
// where sx = 2 x - width and sy = 2 y - height are exact.
typedef struct {
    Packed3 direction;
    Index width;
    Packed3 direction_dx;
    Index height;
    Packed3 direction_dy;
    Index grid;  // samples per side, for RT_SAMPLES_GRID
    Packed3 origin_dx;
    Index max_bounces;
    Packed3 origin_dy;
    Index sphere_count;
    Packed3 background;
    Index triangle_count;
    Packed3 ambient_light;
    Index light_count;
    Index samples;  // of a pixel
    Index filter;   // RT_FILTER_...
    Index seed;     // for Sobol samples
    Index cone_count;
    Index sphere_root;  // root node over all spheres, or 0: test each sphere
    Index cone_root;
    Index triangle_root;
    Index eye_on_surface;   // 1: a perspective camera's eye touches a sphere or cone or lies in
                            // a triangle's plane
    Packed3 direction_low;  // parts of direction and its steps lost to rounding
    Index sampling;         // RT_SAMPLES_...
    Packed3 direction_dx_low;
    Real tolerance;  // of an edges mode; else 0
    Packed3 direction_dy_low;
    Real threshold;  // of an adaptive mode; else 0
} LaunchParams;

// The pixels of one launch: picture columns from x, rows from y, counted from the top. Its first
// pixel goes to film[first], each further row film_width pixels later.
typedef struct {
    Index x, y, width, height;
    Index first, film_width;
    Index pad[2];
} Tile;

typedef struct {
    RT_COUNT primary;  // beyond LaunchParams::samples of a pixel
    RT_COUNT shadow, mirror, transmitted;
} RayCounts;

// A single ray to trace, outside a picture (kernels/rays.cl).
typedef struct {
    Packed3 origin;
    Real t_max;     // where finite, also find out whether anything lies in (0, t_max]
    Packed3 dir;    // unit
    Index from;     // the primitive the origin lies on, or RT_NONE
    Packed3 next;   // unit: continue from the hit in this direction; 0: do not
    Real self_hit;  // as in Ray (kernels/scene_view.h)
} RayQuery;

typedef struct {
    Real t, u, v;
    Index prim;     // RT_NONE: a miss; then only is_blocked is meaningful
    Packed3 point;  // on the surface
    Index is_blocked;
    Packed3 normal;   // shading normal
    Index next_prim;  // hit by the continued ray
    Real next_t;
    Real pad[3];
} RayAnswer;

// The arrays of a scene, X(type, name, what), in the order of a kernel's arguments.
#define RT_SCENE_ARRAYS(X)                                 \
    X(Sphere, spheres, "the spheres")                      \
    X(Cone, cones, "the cones")                            \
    X(Triangle, triangles, "the triangles")                \
    X(VertexNormals, vertex_normals, "the vertex normals") \
    X(Material, materials, "the materials")                \
    X(Light, lights, "the lights")                         \
    X(BvhNode, nodes, "the hierarchy")                     \
    X(Index, order, "the primitives' order")               \
    X(Index, casters, "the shadow casters")

enum { RT_NONE = -1 };

// Sphere::touches, Cone::touches: where the eye and the lights are that lie on the surface or
// nearer to it than rounding can tell, two bits each: RT_ON, or the side. From the eye's bits up,
// light i's for i below the last one's, those of all others, and two that are 0.
enum { RT_OUTSIDE = 1, RT_INSIDE = 2, RT_ON = 3 };
enum { RT_TOUCHES_FIRST_LIGHT = 2, RT_TOUCHES_LIGHTS = 14, RT_TOUCHES_NO_LIGHT = 30 };

// Ray::from of rays that start at an eye on some surface (LaunchParams::eye_on_surface).
enum { RT_EYE = -2 };

// Capacity of the traversal stack: the most nodes ever deferred.
enum { RT_BVH_STACK = 64 };

// Most refracted rays pending at once: one for each bounce where light is both reflected and
// transmitted (kernels/whitted.cl).
enum { RT_TREE_STACK = 16 };

// Most samples per pixel in a packet of neighboring pixels (kernels/packet.cl).
enum { RT_SAMPLES_TOGETHER = 4 };

// Pixels around a tile that adaptive and edges modes look at (kernels/planes.cl), and the rounds of
// an edges mode; an adaptive one has two.
enum { RT_ADAPTIVE_MARGIN = 2, RT_EDGE_MARGIN = 5, RT_EDGE_ROUNDS = 4 };

// Sample positions in a pixel (kernels/sampling.cl).
enum { RT_SAMPLES_GRID = 0, RT_SAMPLES_SOBOL = 1 };

// Reconstruction filters (kernels/sampling.cl).
enum { RT_FILTER_BOX = 0, RT_FILTER_TENT = 1, RT_FILTER_GAUSSIAN = 2, RT_FILTER_MITCHELL = 3 };

// Structs without padding have one layout, so that a wrong one fails to build wherever it is.
RT_STATIC_ASSERT(sizeof(Packed3) == 3 * sizeof(Real));
RT_STATIC_ASSERT(sizeof(Index) == sizeof(Real));
RT_STATIC_ASSERT(sizeof(Sphere) == 12 * sizeof(Real));
RT_STATIC_ASSERT(sizeof(Cone) == 12 * sizeof(Real));
RT_STATIC_ASSERT(sizeof(Triangle) == 16 * sizeof(Real));
RT_STATIC_ASSERT(sizeof(VertexNormals) == 12 * sizeof(Real));
RT_STATIC_ASSERT(sizeof(Material) == 20 * sizeof(Real));
RT_STATIC_ASSERT(sizeof(Light) == 8 * sizeof(Real));
RT_STATIC_ASSERT(sizeof(BvhNode) == 8 * sizeof(Real));
RT_STATIC_ASSERT(sizeof(LaunchParams) == 48 * sizeof(Real));
RT_STATIC_ASSERT(sizeof(Tile) == 8 * sizeof(Real));
RT_STATIC_ASSERT(sizeof(RayCounts) == 32);
RT_STATIC_ASSERT(sizeof(RayQuery) == 12 * sizeof(Real));
RT_STATIC_ASSERT(sizeof(RayAnswer) == 16 * sizeof(Real));
