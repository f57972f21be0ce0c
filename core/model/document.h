// What a person works on, as one value: the picture, the probes on it, and how they deform it.
#pragma once

#include <string>
#include <vector>

#include "model/deform.h"
#include "model/image.h"
#include "model/mesh.h"
#include "model/probe.h"
#include "model/weights.h"

namespace probewarp {

struct Document {
    PicturePtr picture;  ///< shared: undo keeps many documents and one picture; null only before one is open
    std::vector<Probe> probes;  ///< in the order they were put down, ids unique
    int cells = default_cells;  ///< of the mesh, along the picture's longer side
    std::string weights{weight_schemes()[0].name};
    std::string blend{blend_methods()[0].name};

    friend bool operator==(const Document&, const Document&) = default;
};

/// The picture's centre, image pixels: the DCN arithmetic runs about it.
glm::dvec2 centre(const Image& image);

/// The probe of that id, or null.
Probe* find_probe(Document& document, int id);
const Probe* find_probe(const Document& document, int id);

/// A probe at `rest` with a fresh id, the next colour, and a reach of an eighth of the picture's longer side.
Probe new_probe(const Document& document, glm::dvec2 rest);

/// Puts another picture under the probes. Where its size differs, they keep their places relative to its
/// centre and its longer side.
void replace_picture(Document& document, PicturePtr picture);

/// Throws Error where the mesh and the probes together would need more than max_weights weights.
void check_size(const Document& document);

/// A document's deformation, worked out from it and kept: only what changed since the last update is computed
/// anew.
struct Deformation {
    Mesh mesh;
    std::vector<float> weights;                       ///< #vertices x #probes, row-major
    std::vector<DualComplex<float>> transformations;  ///< #probes, about the picture's centre
    std::vector<glm::vec2> now;                       ///< #vertices, image pixels
    std::size_t cancelled = 0;                        ///< vertices whose weights cancel
    Document source;                                  ///< what all of this was worked out from
    unsigned long mesh_version = 0;                   ///< grows with every new mesh
    unsigned long version = 0;                        ///< grows with every change
};

/// Brings `deformation` up to date with `document`, which must have a picture.
void update(Deformation& deformation, const Document& document);

struct PicturePose {
    glm::dvec2 rest;  ///< image pixels on the undeformed picture
    double angle;     ///< radians: how far the picture is turned there
};

/// What lies under `point` of the deformed picture; empty beside it.
std::optional<PicturePose> pose_at(const Deformation& deformation, glm::dvec2 point);

}  // namespace probewarp
