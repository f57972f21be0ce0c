// The binding: what the probes' rest positions give, before anything is dragged: the mesh and the automatic
// weights. It may take long, so it is a value of its own that a thread can work out beside the window.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "model/document.h"
#include "model/still_cells.h"

namespace probewarp {

struct Binding {
    std::shared_ptr<const Mesh> mesh;  ///< shared with the next binding where the mesh stays the same
    Islands islands;                   ///< of the mesh
    /// #islands: the probe (its place in the document) that an island without one follows, else no_vertex.
    /// Empty where the scheme is not measured in the shape, or there are no probes.
    std::vector<std::uint32_t> followed;
    std::vector<float> automatic;        ///< #vertices x #probes, row-major, the largest of each row 1
    Document source;                     ///< what it was worked out from
    std::vector<std::uint8_t> kept;      ///< the picture's visible_cells, to be used again
    std::shared_ptr<WeightCache> cache;  ///< likewise
    StillCells still;                    ///< of the picture: what stays under the mesh
};

/// Whether two documents are bound by the same means: the same picture, mesh settings and scheme. What may
/// differ is where their probes rest.
bool same_means(const Document& a, const Document& b);

/// Whether two documents have the same binding.
bool binds_alike(const Document& a, const Document& b);

/// Whether `binding` (may be null) is what make_binding would give for `document`.
bool is_bound(const Binding* binding, const Document& document);

/// Whether `binding` (may be null) has a column for each of the document's probes: it can deform, if not as
/// it should.
bool fits(const Binding* binding, const Document& document);

/// Works out the binding; `before` (may be null) gives what can be used again, and must not be bound from
/// elsewhere meanwhile. Requires a picture. Throws Error where there are more weights than fit, GivenUp where
/// `given_up` became true.
std::shared_ptr<const Binding> make_binding(const Document& document,
                                            const std::shared_ptr<const Binding>& before,
                                            const std::atomic<bool>* given_up = nullptr);

/// `binding` (may be null) for the same probes on another picture, where that gives the same: it is as large
/// and shows the same cells. Else null.
std::shared_ptr<const Binding> carried_over(const std::shared_ptr<const Binding>& binding,
                                            const Document& document);

/// Islands that have no probe of their own and follow the nearest one.
int lone_islands(const Binding& binding);

}  // namespace probewarp
