// A document's deformation, worked out from it and kept: only what changed since the last time is computed
// anew.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "model/binding.h"
#include "model/deform_tiles.h"

namespace probewarp {

/// What a deformation keeps to be quick. As large as the weights, so a copy goes without and makes its own.
struct Quick {
    WeightTiles tiles;  ///< the weights that deform; of no vertices: to be made
    OthersSum others;   ///< of `tiles` and the pose's other probes; without any: no probe is dragged

    Quick() = default;
    Quick(Quick&&) = default;
    Quick(const Quick&) {}
    Quick& operator=(Quick&&) = default;
    Quick& operator=(const Quick&) { return *this = Quick(); }
};

struct Deformation {
    std::shared_ptr<const Binding> binding;  ///< null before the first update
    /// #vertices x #probes, row-major: the automatic weights with paint, stiffness and limits; null where
    /// there are none of these. Copies share it until one of them changes it.
    std::shared_ptr<std::vector<float>> refined;
    std::vector<Motion<double>> motions;              ///< #probes, about the picture's centre
    std::vector<DualComplex<float>> transformations;  ///< #probes: the motions' DCNs
    std::vector<glm::vec2> now;                       ///< #vertices, image pixels
    std::size_t cancelled = 0;                        ///< vertices for which the blend has no answer
    bool moved = false;                               ///< whether any probe has moved
    Document source;                                  ///< what all of this was worked out from
    unsigned long mesh_version = 0;                   ///< grows with every new mesh
    unsigned long version = 0;                        ///< grows with every change
    Quick quick;
    bool dragged = false;  ///< whether `now` is of a drag: equal to what it would be at rest but for rounding
};

const Mesh& mesh_of(const Deformation& deformation);

/// The weights that deform: #vertices x #probes, row-major.
std::span<const float> weights_of(const Deformation& deformation);

/// What the weights that deform follow from: who keeps this need not look at the weights themselves.
struct WeightsKey {
    std::shared_ptr<const Binding> binding;
    Document unposed;  ///< what the deformation is of
    friend bool operator==(const WeightsKey&, const WeightsKey&) = default;
};
WeightsKey weights_key(const Deformation& deformation);

/// The DCNs of a document's pose, about its picture's centre, as Deformation::transformations: #probes.
std::vector<DualComplex<float>> transformations_of(const Document& document);

/// Whether the pose is about to change again, as while a probe is dragged: then the vertices are moved by the
/// quickest way, and the next time that it is not, by the usual one.
enum class Pace { settled, dragging };

/// Brings `deformation` up to date with `document`, which must have a picture. Throws Error as make_binding
/// does, and then nothing is changed.
void update(Deformation& deformation, const Document& document, Pace pace = Pace::settled);

/// Brings everything but the binding up to date: `binding` may be of an earlier state, but must fit the
/// document.
void pose(Deformation& deformation, const Document& document, std::shared_ptr<const Binding> binding,
          Pace pace = Pace::settled);

/// How much work pose() has with the weights before it moves anything, where the deformation keeps its
/// binding: about the number of weights to be settled. 0 where they are the document's already.
std::size_t refining_work(const Deformation& deformation, const Document& document);

/// The document `weighed` in the pose of `posed`, which has the same probes: what can be shown while the
/// weights of `posed` are not there yet. Empty where the probes are others.
std::optional<Document> in_pose_of(const Document& weighed, const Document& posed);

/// Puts a deformation that was worked out elsewhere in the place of another one, whose versions go on.
void replace(Deformation& deformation, Deformation made);

/// Where another blend takes the vertices in the same pose: #vertices, image pixels.
std::vector<glm::vec2> positions_by(const Deformation& deformation, const BlendMethod& blend);

struct PicturePose {
    glm::dvec2 rest;  ///< image pixels on the undeformed picture
    double angle;     ///< radians: how far the picture is turned there
};

/// What lies under `point` of the deformed picture; empty beside it.
std::optional<PicturePose> pose_at(const Deformation& deformation, glm::dvec2 point);

/// Each probe's share at a place of the mesh: #probes, sums to 1. Empty without probes.
std::vector<double> shares_at(const Deformation& deformation, const MeshPoint& at);

}  // namespace probewarp
