// SPDX-License-Identifier: Apache-2.0
#include "host/scene/obj_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "host/base/text.h"
#include "host/scene/mesh_builder.h"
#include "host/scene/obj_chunk.h"
#include "host/scene/obj_materials.h"

namespace rt {
namespace {

/// Reads the chunks of a file in parallel, first vertices, then faces, and joins them in file
/// order.
class ObjReader {
   public:
    ObjReader(std::string_view text, const std::string& file_name, const ReadPace& pace)
        : mistakes_(text, file_name), file_name_(file_name), pace_(pace) {
        const std::vector<std::size_t> cuts = line_cuts(text, pace.chunk_bytes);
        for (std::size_t i = 1; i < cuts.size(); ++i) {
            chunks_.emplace_back(mistakes_, cuts[i - 1], cuts[i]);
        }
    }

    Model read(const OpenLibrary& open) {
        read_chunks();
        std::size_t triangles = 0;
        for (const ObjChunk& chunk : chunks_) triangles += chunk.faces.size();
        builder_.mesh.faces.reserve(triangles);
        for (ObjChunk& chunk : chunks_) add(chunk);
        Model model;
        if (open) model = materials_.load(open, mistakes_);
        const bool no_materials = model.materials.empty() && !materials_.lacks_library();
        model.mesh = builder_.take();
        for (std::string& note : builder_.notes(file_name_)) model.notes.push_back(std::move(note));
        if (no_materials) {
            model.mesh.face_materials = {-1};
        } else {
            materials_.resolve(model, mistakes_);
            mistakes_.throw_if_any();
        }
        if (left_out_ > 0) {
            model.notes.push_back(
                fmt::format("{}: ignored {} (p, l)", file_name_,
                            counted(left_out_, "point or line", "points or lines")));
        }
        return model;
    }

   private:
    template <typename Work>
    void for_each_chunk(Work work) {
        for_each_run(chunks_.size(), 1, pace_.threads,
                     [&](std::size_t i, std::size_t) { work(i); });
    }

    void read_chunks() {
        for_each_chunk([&](std::size_t i) { read_obj_vertices(chunks_[i]); });
        std::vector<ObjCounts> above{{}};
        for (const ObjChunk& chunk : chunks_) {
            above.push_back({above.back().positions + chunk.positions.size(),
                             above.back().normals + chunk.normals.size()});
        }
        std::vector<glm::dvec3>& positions = builder_.mesh.positions;
        std::vector<glm::dvec3>& normals = builder_.mesh.normals;
        positions.resize(above.back().positions);
        normals.resize(above.back().normals);
        for_each_chunk([&](std::size_t i) {
            move_to(chunks_[i].positions, positions.data() + above[i].positions);
            move_to(chunks_[i].normals, normals.data() + above[i].normals);
        });
        for_each_chunk([&](std::size_t i) { read_obj_faces(chunks_[i], above[i], positions); });
        for (const ObjChunk& chunk : chunks_) mistakes_.add_all(chunk.mistakes);
        mistakes_.throw_if_any();
    }

    /// Moves the items and frees their memory.
    static void move_to(std::vector<glm::dvec3>& items, glm::dvec3* target) {
        std::ranges::copy(items, target);
        std::vector<glm::dvec3>().swap(items);
    }

    void add(ObjChunk& chunk) {
        const std::span<const Scene::Mesh::Face> faces = chunk.faces, normals = chunk.face_normals;
        std::size_t done = 0;
        const auto add_up_to = [&](std::size_t end) {
            builder_.add_triangles(faces.subspan(done, end - done),
                                   normals.empty() ? normals : normals.subspan(done, end - done));
            done = end;
        };
        for (const ObjEvent& event : chunk.events) {
            add_up_to(event.faces_before);
            if (const auto* polygon = std::get_if<ObjPolygon>(&event.what)) {
                builder_.add_face(polygon->corners, polygon->normals);
            } else {
                builder_.use_material(materials_.use(std::get<ObjMaterialUse>(event.what)));
            }
        }
        add_up_to(faces.size());
        for (const ObjLibraryUse& library : chunk.libraries) materials_.note_library(library);
        left_out_ += chunk.left_out;
        chunk = ObjChunk(mistakes_, 0, 0);
    }

    Mistakes mistakes_;
    std::string file_name_;
    ReadPace pace_;
    std::vector<ObjChunk> chunks_;
    MeshBuilder builder_;
    ObjMaterials materials_;
    std::size_t left_out_ = 0;
};

}  // namespace

Model parse_obj(std::string_view text, const std::string& file_name, const OpenLibrary& open,
                const ReadPace& pace) {
    return ObjReader(text, file_name, pace).read(open);
}

}  // namespace rt
