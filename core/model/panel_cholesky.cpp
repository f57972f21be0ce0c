#include "model/panel_cholesky.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <utility>

namespace probewarp {

namespace {

/// Hands each column of the factor to take(column, rows): its rows below the diagonal, ascending. A column's
/// are its own in the matrix and those of the columns whose first row below it is.
template <class Take>
void for_each_column(const SparseMatrix& matrix, Take take) {
    const int columns = int(matrix.cols());
    std::vector<std::vector<int>> waiting(static_cast<std::size_t>(columns));
    std::vector<int> rows, merged;
    for (int j = 0; j < columns; ++j) {
        rows.clear();
        for (SparseMatrix::InnerIterator at(matrix, j); at; ++at)
            if (at.row() > j) rows.push_back(int(at.row()));
        std::sort(rows.begin(), rows.end());
        // What children left here: their rows from this one on, one list after the other.
        std::vector<int> left = std::move(waiting[std::size_t(j)]);
        for (auto begin = left.begin(); begin != left.end();) {
            const int count = *begin++;
            merged.clear();
            std::set_union(rows.begin(), rows.end(), begin, begin + count, std::back_inserter(merged));
            std::swap(rows, merged);
            begin += count;
        }
        take(j, std::as_const(rows));
        if (rows.size() < 2) continue;
        auto& parent = waiting[std::size_t(rows.front())];
        parent.push_back(int(rows.size()) - 1);
        parent.insert(parent.end(), rows.begin() + 1, rows.end());
    }
}

}  // namespace

Panels panels_of(const SparseMatrix& matrix) {
    Panels panels;
    panels.panel_of.resize(std::size_t(matrix.cols()));
    std::vector<int> before;   // the rows of the column before
    const auto finish = [&] {  // the panel so far: its last column's rows are those below it
        if (panels.panels.empty()) return;
        Panels::Panel& panel = panels.panels.back();
        panel.below = panels.rows.size();
        panel.rows_below = int(before.size());
        panel.values = panels.value_count;
        panels.rows.insert(panels.rows.end(), before.begin(), before.end());
        panels.value_count += panel.value_count();
    };
    for_each_column(matrix, [&](int column, const std::vector<int>& rows) {
        const bool continues =
            !before.empty() && before.front() == column && before.size() == rows.size() + 1;
        if (!continues) {
            finish();
            panels.panels.push_back({column, 0, 0, 0, 0});
        }
        ++panels.panels.back().columns;
        panels.panel_of[std::size_t(column)] = int(panels.panels.size()) - 1;
        before = rows;
    });
    finish();
    return panels;
}

PanelCholesky prepare_cholesky(const SparseMatrix& matrix) {
    PanelCholesky cholesky{panels_of(matrix), {}, {}, {}, {}, {}};
    const Panels& panels = cholesky.panels;
    std::vector<std::pair<int, PanelCholesky::Update>> all;  // with the later panel
    for (std::size_t p = 0; p < panels.panels.size(); ++p) {
        const Panels::Panel& panel = panels.panels[p];
        const auto target = [&](int i) {
            return panels.panel_of[std::size_t(panels.rows[panel.below + std::size_t(i)])];
        };
        for (int first = 0, end; first < panel.rows_below; first = end) {
            for (end = first + 1; end < panel.rows_below && target(end) == target(first);) ++end;
            all.push_back({target(first), {int(p), first, end}});
        }
    }
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    cholesky.first_update.assign(panels.panels.size() + 1, 0);
    for (const auto& [target, update] : all) {
        cholesky.updates.push_back(update);
        ++cholesky.first_update[std::size_t(target) + 1];
    }
    for (std::size_t p = 0; p < panels.panels.size(); ++p)
        cholesky.first_update[p + 1] += cholesky.first_update[p];
    cholesky.matrix.resize(std::size_t(matrix.nonZeros()));
    cholesky.stale.assign(panels.panels.size(), 1);
    return cholesky;
}

namespace {

using Dense = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Works panels out; what it needs meanwhile.
class PanelFactory {
  public:
    explicit PanelFactory(PanelCholesky& cholesky)
        : cholesky_(cholesky), place_(cholesky.panels.panel_of.size()) {}

    void make(std::size_t p, const SparseMatrix& matrix) {
        const Panels::Panel& panel = cholesky_.panels.panels[p];
        place_rows(panel);
        enter(panel, matrix);
        for (std::size_t u = cholesky_.first_update[p]; u < cholesky_.first_update[p + 1]; ++u)
            subtract(panel, cholesky_.updates[u]);
        factor(panel);
    }

  private:
    const int* rows_below(const Panels::Panel& panel) const { return &cholesky_.panels.rows[panel.below]; }
    double* values(const Panels::Panel& panel) { return cholesky_.values.data() + panel.values; }

    /// Which row of the panel each row of the matrix is.
    void place_rows(const Panels::Panel& panel) {
        for (int k = 0; k < panel.columns; ++k) place_[std::size_t(panel.first + k)] = k;
        for (int k = 0; k < panel.rows_below; ++k)
            place_[std::size_t(rows_below(panel)[k])] = panel.columns + k;
    }

    void enter(const Panels::Panel& panel, const SparseMatrix& matrix) {
        std::fill_n(values(panel), panel.value_count(), 0.0);
        for (int k = 0; k < panel.columns; ++k)
            for (SparseMatrix::InnerIterator at(matrix, panel.first + k); at; ++at)
                if (at.row() >= panel.first + k)
                    values(panel)[place_[std::size_t(at.row())] * panel.columns + k] = at.value();
    }

    void subtract(const Panels::Panel& panel, const PanelCholesky::Update& update) {
        const Panels::Panel& from = cholesky_.panels.panels[std::size_t(update.panel)];
        const Eigen::Index count = from.rows_below - update.first, across = update.end - update.first;
        const double* first = values(from) + (from.columns + update.first) * from.columns;
        const Eigen::Map<const Dense> all(first, count, from.columns), own(first, across, from.columns);
        if (work_.size() < count * across) work_.resize(count * across);
        Eigen::Map<Dense> work(work_.data(), count, across);
        // Below some hundred products Eigen's blocked way costs more than it saves.
        if (count * across * from.columns < 512)
            work.noalias() = all.lazyProduct(own.transpose());
        else
            work.noalias() = all * own.transpose();
        const int* rows = rows_below(from) + update.first;
        for (Eigen::Index i = 0; i < count; ++i) {
            double* to = values(panel) + place_[std::size_t(rows[i])] * panel.columns;
            for (Eigen::Index j = 0; j < across; ++j) to[rows[j] - panel.first] -= work(i, j);
        }
    }

    void factor(const Panels::Panel& panel) {
        Eigen::Map<Dense> own(values(panel), panel.columns, panel.columns);
        Eigen::Map<Dense> below(own.data() + own.size(), panel.rows_below, panel.columns);
        Eigen::LLT<Eigen::Ref<Dense>> llt(own);
        check_factored(llt.info());
        own.transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(below);
        own.triangularView<Eigen::StrictlyUpper>().setZero();
        own.diagonal() = own.diagonal().cwiseInverse();
    }

    PanelCholesky& cholesky_;
    std::vector<int> place_;
    Eigen::VectorXd work_;
};

/// Marks the panels whose columns differ from what the factor is of, and all that come after them in the
/// tree.
void mark_stale(PanelCholesky& cholesky, const SparseMatrix& matrix) {
    const int* starts = matrix.outerIndexPtr();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
        for (int k = starts[j]; k < starts[j + 1]; ++k)
            if (cholesky.matrix[std::size_t(k)] != matrix.valuePtr()[k]) {
                cholesky.matrix[std::size_t(k)] = matrix.valuePtr()[k];
                cholesky.stale[std::size_t(cholesky.panels.panel_of[std::size_t(j)])] = 1;
            }
    for (std::size_t p = 0; p < cholesky.stale.size(); ++p) {
        const Panels::Panel& panel = cholesky.panels.panels[p];
        if (!cholesky.stale[p] || panel.rows_below == 0) continue;
        const int parent = cholesky.panels.rows[panel.below];
        cholesky.stale[std::size_t(cholesky.panels.panel_of[std::size_t(parent)])] = 1;
    }
}

}  // namespace

std::size_t update_cholesky(PanelCholesky& cholesky, const SparseMatrix& matrix,
                            const std::function<void()>& check) {
    assert(matrix.isCompressed() && std::size_t(matrix.nonZeros()) == cholesky.matrix.size());
    cholesky.values.resize(cholesky.panels.value_count);
    mark_stale(cholesky, matrix);
    PanelFactory factory(cholesky);
    std::size_t made = 0;
    for (std::size_t p = 0; p < cholesky.stale.size(); ++p) {
        if (!cholesky.stale[p]) continue;
        check();
        factory.make(p, matrix);
        cholesky.stale[p] = 0;
        ++made;
    }
    return made;
}

}  // namespace probewarp
