// From the automatic weights to those that deform: paint is settled over them, stiff regions are made to move
// as one, and what a vertex may not follow is dropped.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "model/binding.h"

namespace probewarp {

/// Whether a vertex may follow fewer probes than there are.
bool is_limited(const Document& document);

/// Whether anything refines the document's automatic weights; else they deform as they are.
bool is_refined(const Document& document);

/// The vertices whose refined weights may differ between the two documents, which differ in nothing but their
/// probes' paint (and in what does not touch the weights): runs in the vertices' order.
std::vector<VertexRun> repainted(const Document& before, const Document& after, const Mesh& mesh);

/// Writes the settled, limited weights of one run of vertices, without stiffness.
/// weights: run.count x #probes, row-major
void settle_run(const Document& document, const Binding& binding, VertexRun run, std::span<float> weights);

/// The vertices that are a probe's own, ascending.
std::vector<std::uint32_t> anchored_vertices(const Mesh& mesh);

/// At its own vertex a probe has all the automatic weight, and nobody is there to divide what paint takes
/// from it. So the more of the vertex is `covered`, in [0, 1], the more its row becomes the mean of the rows
/// at its cell's corners. anchored: as above; row: #probes, in: the vertex's automatic weights; out:
/// likewise, summing to 1
void open_anchor(const Binding& binding, std::span<const std::uint32_t> anchored, std::size_t vertex,
                 float covered, std::span<float> row);

/// Makes regions rigid: vertices that hang together where the stiffness is at least a half are a region, and
/// less stiff ones beside it belong to it too; each vertex of stiffness s takes the part s of the region's
/// mean weights (of shares that sum to 1, weighted by stiffness) and 1 - s of its own. stiffness: #vertices,
/// [0, 1]; weights: #vertices x #probes, row-major, in and out
void stiffen(const Mesh& mesh, std::span<const float> stiffness, std::size_t probes,
             std::span<float> weights);

/// Value times coverage of the stiffness paint at each vertex: #vertices.
std::vector<float> stiffness_at(const PaintMap& paint, const PictureFrame& frame,
                                std::span<const glm::vec2> vertices);

/// All of it: #vertices x #probes, row-major.
std::vector<float> refined_weights(const Document& document, const Binding& binding);

}  // namespace probewarp
