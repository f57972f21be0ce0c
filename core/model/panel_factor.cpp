#include "model/panel_factor.h"

#include <cmath>
#include <set>

namespace probewarp {

DiagonalRaiser::DiagonalRaiser(const Panels& panels)
    : panels_(panels), update_(panels.panel_of.size(), std::array<float, 3>{}) {}

namespace {

/// The rotations that take three updates' columns into one of the factor's.
struct Turn {
    std::array<float, 3> cosine, tangent, inverse;
};

/// Makes a column's turns from its diagonal, which stands inverted and is turned too, and what the updates
/// have there.
Turn turn_diagonal(float& inverted, const std::array<float, 3>& update) {
    Turn turn;
    for (std::size_t k = 0; k < 3; ++k) {
        turn.tangent[k] = update[k] * inverted;
        turn.inverse[k] = std::sqrt(1 + turn.tangent[k] * turn.tangent[k]);
        turn.cosine[k] = 1 / turn.inverse[k];
        inverted *= turn.cosine[k];
    }
    return turn;
}

/// Turns the entries of `count` rows, `stride` apart, in the columns that have turns; rows: the updates'
/// rows. Several rows at once, for each is one long chain of operations.
template <int count>
void turn_rows(std::span<const Turn> turns, float* entries, std::size_t stride,
               const std::array<std::array<float, 3>*, std::size_t(count)>& rows) {
    using Several = Eigen::Array<float, count, 1>;
    std::array<Several, 3> update;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < count; ++i) update[k][Eigen::Index(i)] = (*rows[i])[k];
    for (std::size_t j = 0; j < turns.size(); ++j) {
        const Turn& turn = turns[j];
        Several entry;
        for (std::size_t i = 0; i < count; ++i) entry[Eigen::Index(i)] = entries[i * stride + j];
        for (std::size_t k = 0; k < 3; ++k) {
            entry = (entry + turn.tangent[k] * update[k]) * turn.cosine[k];
            update[k] = update[k] * turn.inverse[k] - turn.tangent[k] * entry;
        }
        for (std::size_t i = 0; i < count; ++i) entries[i * stride + j] = entry[Eigen::Index(i)];
    }
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < count; ++i) (*rows[i])[k] = update[k][Eigen::Index(i)];
}

}  // namespace

void DiagonalRaiser::raise(const std::array<Raise, 3>& raises, std::span<float> values) {
    std::set<int> reached;  // panels; each passes what is left on to the one of its first row below
    for (std::size_t k = 0; k < raises.size(); ++k) {
        if (raises[k].by == 0) continue;
        update_[std::size_t(raises[k].at)][k] = std::sqrt(raises[k].by);
        reached.insert(panels_.panel_of[std::size_t(raises[k].at)]);
    }
    while (!reached.empty()) {
        const Panels::Panel& panel = panels_.panels[std::size_t(*reached.begin())];
        reached.erase(reached.begin());
        raise_panel(panel, values);
        if (panel.rows_below > 0) reached.insert(panels_.panel_of[std::size_t(panels_.rows[panel.below])]);
    }
}

void DiagonalRaiser::raise_panel(const Panels::Panel& panel, std::span<float> values) {
    const auto stride = std::size_t(panel.columns);
    std::vector<Turn> turns;
    float* entries = values.data() + panel.values;
    for (std::size_t j = 0; j < stride; ++j, entries += stride) {
        auto& update = update_[std::size_t(panel.first) + j];
        turn_rows<1>(turns, entries, stride, {&update});
        turns.push_back(turn_diagonal(entries[j], update));
        update = {};
    }
    const auto update = [&](int i) {
        return &update_[std::size_t(panels_.rows[panel.below + std::size_t(i)])];
    };
    int i = 0;
    for (; i + 4 <= panel.rows_below; i += 4, entries += 4 * stride)
        turn_rows<4>(turns, entries, stride, {update(i), update(i + 1), update(i + 2), update(i + 3)});
    for (; i < panel.rows_below; ++i, entries += stride) turn_rows<1>(turns, entries, stride, {update(i)});
}

namespace {

template <class T>
using Row = Eigen::Array<T, 1, side_by_side<T>>;

/// L x = sides, for the panel's columns and what they take from the rows below.
template <class T>
void forward(const Panels& panels, const Panels::Panel& panel, const T* entries, Sides<T>& sides) {
    for (int j = 0; j < panel.columns; ++j, entries += panel.columns) {
        Row<T> x = sides.row(panel.first + j);
        for (int k = 0; k < j; ++k) x -= entries[k] * sides.row(panel.first + k);
        sides.row(panel.first + j) = x * entries[j];
    }
    for (int i = 0; i < panel.rows_below; ++i, entries += panel.columns) {
        const int row = panels.rows[panel.below + std::size_t(i)];
        Row<T> x = sides.row(row);
        for (int k = 0; k < panel.columns; ++k) x -= entries[k] * sides.row(panel.first + k);
        sides.row(row) = x;
    }
}

/// Takes what the rows below have from `count` columns at once, so that each of these rows is read once.
/// entries: the rows below
template <int count, class T>
void take_below(const Panels& panels, const Panels::Panel& panel, const T* entries, int column,
                Sides<T>& sides) {
    std::array<Row<T>, count> x;
    for (int k = 0; k < count; ++k) x[std::size_t(k)] = sides.row(panel.first + column + k);
    entries += column;
    for (int i = 0; i < panel.rows_below; ++i, entries += panel.columns) {
        const Row<T> y = sides.row(panels.rows[panel.below + std::size_t(i)]);
        for (int k = 0; k < count; ++k) x[std::size_t(k)] -= entries[k] * y;
    }
    for (int k = 0; k < count; ++k) sides.row(panel.first + column + k) = x[std::size_t(k)];
}

/// L^T x = sides, for the panel's columns.
template <class T>
void backward(const Panels& panels, const Panels::Panel& panel, const T* own, Sides<T>& sides) {
    const T* below = own + panel.columns * panel.columns;
    constexpr int together = sizeof(T) == 4 ? 4 : 2;  // as the plainest processors have registers for
    int column = 0;
    for (; column + together <= panel.columns; column += together)
        take_below<together>(panels, panel, below, column, sides);
    for (; column < panel.columns; ++column) take_below<1>(panels, panel, below, column, sides);
    for (int j = panel.columns; j-- > 0;) {
        Row<T> x = sides.row(panel.first + j);
        for (int k = j + 1; k < panel.columns; ++k)
            x -= own[k * panel.columns + j] * sides.row(panel.first + k);
        sides.row(panel.first + j) = x * own[j * panel.columns + j];
    }
}

}  // namespace

template <class T>
void solve_by_panels(const Panels& panels, std::span<const T> values, Sides<T>& sides) {
    for (const Panels::Panel& panel : panels.panels)
        forward(panels, panel, values.data() + panel.values, sides);
    for (auto panel = panels.panels.rbegin(); panel != panels.panels.rend(); ++panel)
        backward(panels, *panel, values.data() + panel->values, sides);
}

template void solve_by_panels(const Panels&, std::span<const float>, Sides<float>&);
template void solve_by_panels(const Panels&, std::span<const double>, Sides<double>&);

}  // namespace probewarp
