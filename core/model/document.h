// What a person works on, as one value: the picture, the probes on it, and how they deform it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "model/deform.h"
#include "model/image.h"
#include "model/mesh.h"
#include "model/paint.h"
#include "model/probe.h"
#include "model/weights.h"

namespace probewarp {

struct Document {
    PicturePtr picture;  ///< shared: undo keeps many documents and one picture; null only before one is open
    std::vector<Probe> probes;  ///< in the order they were put down, ids unique
    MeshSettings mesh;
    WeightSettings weights;
    std::string blend{blend_methods()[0].name};
    PaintPtr stiffness;  ///< where the picture stays rigid: value times coverage; null: nowhere

    friend bool operator==(const Document&, const Document&) = default;
};

/// The picture's centre, image pixels: the DCN arithmetic runs about it.
glm::dvec2 centre(const Image& image);

/// Where the picture lies, for its paint.
PictureFrame frame_of(const Image& image);

/// The paint to be changed: a copy, or an empty map over the picture where it is null.
PaintMap map_of(const Document& document, const PaintPtr& paint);

/// The probe of that id, or null.
Probe* find_probe(Document& document, int id);
const Probe* find_probe(const Document& document, int id);

/// The place among the document's probes of the one of that id, which must be there.
std::size_t place_of(const Document& document, int id);

/// A probe at `rest` with a fresh id, the next colour, and a reach of an eighth of the picture's longer side.
Probe new_probe(const Document& document, glm::dvec2 rest);

/// The document with every probe at rest: all but the pose.
Document unposed(Document document);

/// Whether any probe has paint.
bool is_painted(const Document& document);

/// Puts another picture under the probes. Where its size differs, they keep their places relative to its
/// centre and its longer side.
void replace_picture(Document& document, PicturePtr picture);

/// Throws Error where the mesh and the probes together would need more than max_weights weights.
void check_size(const Document& document);

}  // namespace probewarp
