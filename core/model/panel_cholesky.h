// Sparse Cholesky factors in panels: what is worked out of them is kept, and only what a change of the matrix
// reaches is worked out anew. Private to the harmonic and the biharmonic weights.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "model/panel_factor.h"

namespace probewarp {

/// Where the Cholesky factor of a symmetric matrix has its entries, eliminated in the matrix's own order.
Panels panels_of(const SparseMatrix& matrix);

/// The factor of one matrix after the other, all of one pattern.
struct PanelCholesky {
    /// Columns of a panel times some of its rows below are to be taken from a later panel.
    struct Update {
        int panel;
        int first, end;  ///< of its rows below: those that lie in the later panel's columns
    };
    Panels panels;
    std::vector<Update> updates;            ///< by the later panel
    std::vector<std::size_t> first_update;  ///< #panels + 1
    std::vector<double> values;             ///< as Panels tells; none before the first update
    std::vector<double> matrix;       ///< of which matrix the values are: its own values, as it has them
    std::vector<std::uint8_t> stale;  ///< #panels: 1 where the values are of another one yet
};

/// Finds the pattern of a symmetric matrix's factor; nothing is factored yet.
PanelCholesky prepare_cholesky(const SparseMatrix& matrix);

/// Brings the factor up to date, panel by panel along the elimination tree (left-looking, by supernodes:
/// Davis, Direct Methods for Sparse Linear Systems, section 4.8): a panel is worked out again where its own
/// columns changed, or a panel's before it in the tree; so every value is, bit for bit, what it would be
/// anew. `check` is called between panels and may throw: what is done stays done. Returns how many panels
/// that were. Throws Error where the matrix is not definite.
std::size_t update_cholesky(PanelCholesky& cholesky, const SparseMatrix& matrix,
                            const std::function<void()>& check);

}  // namespace probewarp
