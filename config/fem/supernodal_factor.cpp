#include "config/fem/supernodal_factor.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "config/fem/fill_order.h"
#include "rt_core/lanes.h"

// The elimination multiplies and adds in one instruction, with one rounding, because it says so: of itself the compiler
// may not (docs/determinism.md). With the blocks below 15 instead of 9 thousand million products a second (2026-11-28).
#if defined(__x86_64__)
#define PALPATE_FUSED [[gnu::target("fma")]]
#else
#define PALPATE_FUSED
#endif

namespace palpate::fem {

namespace {

// Columns whose values one pass over the rest of the front subtracts: they stay in the second-level cache.
constexpr std::size_t kPanel = 32;
// A child joins its parent when the zeros stored for that stay below this share of the block: a body's nodes are blocks
// of three already. Of 101 thousand unknowns, with 0.2: 66 instead of 54 million entries, 5.1 instead of 3.4 s
// (2026-11-26).
constexpr double kZeroShare = 0.03;

// Where in the lower triangle of `rows` rows, packed column by column, a column has row 0, had it one.
std::size_t packed(std::size_t rows, std::size_t column) { return column * rows - column * (column + 1) / 2; }

// One unknown of kWide right hand sides.
template <int kWide>
struct SideRow {
  static constexpr std::size_t kCount = kWide == 1 ? 1 : kWide / 4;
  using Lanes = std::conditional_t<kWide == 1, double, Double4>;
  Lanes lanes[kCount] = {};
  void set(std::size_t k, double value) {
    if constexpr (kWide == 1)
      lanes[k] = value;
    else
      lanes[k / 4][k % 4] = value;
  }
  double at(std::size_t k) const {
    if constexpr (kWide == 1)
      return lanes[k];
    else
      return lanes[k / 4][k % 4];
  }
};

// For every column the rows that the matrix has below its diagonal, in the order of elimination.
std::vector<std::vector<int>> permuted_columns(const Eigen::SparseMatrix<double>& lower,
                                               const std::vector<int>& order) {
  std::vector<std::vector<int>> below(order.size());
  for (int column = 0; column < lower.outerSize(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(lower, column); it; ++it) {
      const int a = order[static_cast<std::size_t>(it.row())], b = order[static_cast<std::size_t>(column)];
      if (a != b) below[static_cast<std::size_t>(std::min(a, b))].push_back(std::max(a, b));
    }
  return below;
}

// Liu's elimination tree from the columns' rows: the parent of a column is the first row it fills.
std::vector<int> elimination_tree(const std::vector<std::vector<int>>& below) {
  const int n = static_cast<int>(below.size());
  std::vector<std::vector<int>> left(below.size());
  for (int j = 0; j < n; ++j)
    for (const int i : below[static_cast<std::size_t>(j)]) left[static_cast<std::size_t>(i)].push_back(j);
  std::vector<int> parent(below.size(), -1), ancestor(below.size(), -1);
  for (int i = 0; i < n; ++i)
    for (int j : left[static_cast<std::size_t>(i)])
      while (j != -1 && j != i) {
        const int next = ancestor[static_cast<std::size_t>(j)];
        ancestor[static_cast<std::size_t>(j)] = i;
        if (next == -1) parent[static_cast<std::size_t>(j)] = i;
        j = next;
      }
  return parent;
}

// Children before parents, every subtree in one piece.
std::vector<int> postorder(const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  std::vector<std::vector<int>> children(parent.size() + 1);
  for (int j = n; j-- > 0;) {
    const int p = parent[static_cast<std::size_t>(j)];
    children[static_cast<std::size_t>(p < 0 ? n : p)].push_back(j);
  }
  std::vector<int> place(parent.size()), stack = {n};
  int next = n;
  while (!stack.empty()) {
    const int j = stack.back();
    stack.pop_back();
    if (j < n) place[static_cast<std::size_t>(j)] = --next;
    const auto& c = children[static_cast<std::size_t>(j)];
    stack.insert(stack.end(), c.rbegin(), c.rend());
  }
  return place;
}

// The rows of a column of the factor, its children's among them; hands them on to the column's parent.
std::vector<int> filled_rows(std::vector<std::vector<int>>& below, const std::vector<int>& parent, std::size_t j) {
  std::vector<int> rows = std::move(below[j]);
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  if (parent[j] < 0) return rows;
  std::vector<int>& up = below[static_cast<std::size_t>(parent[j])];
  up.insert(up.end(), rows.begin() + 1, rows.end());  // the first is the parent itself
  return rows;
}

PALPATE_FUSED inline void subtract(const double* __restrict what, double factor, std::size_t first, std::size_t rows,
                                   double* __restrict from) {
  for (std::size_t i = first; i < rows; ++i) from[i] = std::fma(factor, what[i], from[i]);
}

PALPATE_FUSED inline Double4 fused(double factor, const Double4& what, const Double4& to) {
#if defined(__x86_64__)
  return _mm256_fmadd_pd(splat4(factor), what, to);
#else
  Double4 sum;
  for (int i = 0; i < 4; ++i) sum[i] = std::fma(factor, what[i], to[i]);
  return sum;
#endif
}

constexpr std::size_t kBlockRows = 8, kBlockColumns = 4;  // of the products that stay in registers

// A panel's columns from row `end` on, block by block of rows, what is missing of the last one as zeros.
template <class Columns>
void pack_panel(const Columns& at, std::size_t start, std::size_t end, std::size_t rows,
                std::vector<double>& by_block) {
  const std::size_t width = end - start, blocks = (rows - end + kBlockRows - 1) / kBlockRows;
  by_block.assign(blocks * kBlockRows * width, 0.0);
  for (std::size_t k = 0; k < width; ++k) {
    const double* column = at(start + k) + end;
    for (std::size_t i = 0; i < rows - end; ++i)
      by_block[(i / kBlockRows * width + k) * kBlockRows + i % kBlockRows] = column[i];
  }
}

// to[c] += factor[k][c] panel[k] for a block of rows and of columns.
template <std::size_t kColumns>
PALPATE_FUSED inline void add_products(const double* panel, const double* factor, std::size_t width,
                                       double* const (&to)[kColumns]) {
  Double4 sum[kColumns][2];
  for (std::size_t c = 0; c < kColumns; ++c) {
    sum[c][0] = load4(to[c]);
    sum[c][1] = load4(to[c] + 4);
  }
  for (std::size_t k = 0; k < width; ++k) {
    const Double4 upper = load4(panel + k * kBlockRows), lower = load4(panel + k * kBlockRows + 4);
    for (std::size_t c = 0; c < kColumns; ++c) {
      sum[c][0] = fused(factor[k * kColumns + c], upper, sum[c][0]);
      sum[c][1] = fused(factor[k * kColumns + c], lower, sum[c][1]);
    }
  }
  for (std::size_t c = 0; c < kColumns; ++c)
    for (std::size_t i = 0; i < kBlockRows; ++i) to[c][i] = sum[c][i / 4][i % 4];
}

// Takes the panel's part from columns j to j + kColumns, rows from j on (what lands above the diagonal is never read).
template <std::size_t kColumns, class Columns>
PALPATE_FUSED void subtract_panel(const Columns& at, std::size_t start, std::size_t end, std::size_t j,
                                  std::size_t rows, const double* diagonal, const std::vector<double>& by_block) {
  const std::size_t width = end - start;
  double factor[kPanel * kColumns];
  for (std::size_t k = 0; k < width; ++k)
    for (std::size_t c = 0; c < kColumns; ++c) factor[k * kColumns + c] = -at(start + k)[j + c] * diagonal[start + k];
  for (std::size_t skip = (j - end) / kBlockRows * kBlockRows; end + skip < rows; skip += kBlockRows) {
    const double* panel = by_block.data() + skip * width;
    const std::size_t first = end + skip, left = rows - first;
    double* to[kColumns];
    for (std::size_t c = 0; c < kColumns; ++c) to[c] = at(j + c) + first;
    if (left >= kBlockRows) {
      add_products<kColumns>(panel, factor, width, to);
      continue;
    }
    double whole[kColumns][kBlockRows] = {};
    for (std::size_t c = 0; c < kColumns; ++c) to[c] = std::copy_n(to[c], left, whole[c]) - left;
    add_products<kColumns>(panel, factor, width, to);
    for (std::size_t c = 0; c < kColumns; ++c) std::copy_n(whole[c], left, at(j + c) + first);
  }
}

}  // namespace

void SupernodalFactor::analyse(const Eigen::SparseMatrix<double>& lower) {
  size_ = static_cast<int>(lower.cols());
  new_of_old_ = fill_order(lower);
  const std::vector<int> place = postorder(elimination_tree(permuted_columns(lower, new_of_old_)));
  for (int& k : new_of_old_) k = place[static_cast<std::size_t>(k)];
  find_nodes(permuted_columns(lower, new_of_old_));
  place_entries(lower);
}

void SupernodalFactor::find_nodes(std::vector<std::vector<int>> below) {
  const std::vector<int> parent = elimination_tree(below);
  nodes_.clear();
  std::vector<std::size_t> zeros;  // stored in each node
  for (int j = 0; j < size_; ++j) {
    Node node{j, 1, -1, {j}, 0, {}, {}, {}};
    const std::vector<int> rows = filled_rows(below, parent, static_cast<std::size_t>(j));
    node.rows.insert(node.rows.end(), rows.begin(), rows.end());
    std::size_t empty = 0;
    // The node before this one, when this column is the first it reaches.
    while (!nodes_.empty() && parent[static_cast<std::size_t>(node.first - 1)] == node.first) {
      const Node& before = nodes_.back();
      const std::size_t columns = static_cast<std::size_t>(before.columns),
                        lost = columns * (columns + node.rows.size() - before.rows.size()),
                        total = (columns + static_cast<std::size_t>(node.columns)) * (columns + node.rows.size());
      if (static_cast<double>(zeros.back() + empty + lost) > kZeroShare * static_cast<double>(total)) break;
      empty += zeros.back() + lost;
      node.rows.insert(node.rows.begin(), before.rows.begin(), before.rows.begin() + before.columns);
      node.first = before.first;
      node.columns += before.columns;
      nodes_.pop_back();
      zeros.pop_back();
    }
    nodes_.push_back(std::move(node));
    zeros.push_back(empty);
  }
  std::vector<int> node_of(static_cast<std::size_t>(size_));
  std::size_t panel = 0;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    Node& node = nodes_[k];
    for (int c = 0; c < node.columns; ++c) node_of[static_cast<std::size_t>(node.first + c)] = static_cast<int>(k);
    node.panel = panel;
    panel += packed(node.rows.size(), static_cast<std::size_t>(node.columns)) + static_cast<std::size_t>(node.columns);
  }
  for (Node& node : nodes_)
    if (node.rows.size() > static_cast<std::size_t>(node.columns))
      node.parent = node_of[static_cast<std::size_t>(node.rows[static_cast<std::size_t>(node.columns)])];
  panel_.assign(panel, 0.0);
  diagonal_.assign(static_cast<std::size_t>(size_), 0.0);
}

void SupernodalFactor::place_entries(const Eigen::SparseMatrix<double>& lower) {
  std::vector<int> node_of(static_cast<std::size_t>(size_));
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    for (int c = 0; c < nodes_[k].columns; ++c)
      node_of[static_cast<std::size_t>(nodes_[k].first + c)] = static_cast<int>(k);
  for (int column = 0; column < lower.outerSize(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(lower, column); it; ++it) {
      const int a = new_of_old_[static_cast<std::size_t>(it.row())], b = new_of_old_[static_cast<std::size_t>(column)];
      Node& node = nodes_[static_cast<std::size_t>(node_of[static_cast<std::size_t>(std::min(a, b))])];
      const std::size_t row = static_cast<std::size_t>(
          std::lower_bound(node.rows.begin(), node.rows.end(), std::max(a, b)) - node.rows.begin());
      const std::size_t at = static_cast<std::size_t>(std::min(a, b) - node.first) * node.rows.size() + row;
      node.entry.push_back(static_cast<std::uint32_t>(&it.value() - lower.valuePtr()));
      node.entry_at.push_back(static_cast<std::uint32_t>(at));
      if (a == b) node.diagonal_at.push_back(static_cast<std::uint32_t>(at));
    }
}

// The first `columns` of a square front, lower triangle, column by column: L below the diagonal (which stays 1,
// unwritten), D apart, and the rest of the front less what they carry.
bool SupernodalFactor::eliminate(std::vector<double>& front, std::size_t rows, std::size_t columns, double* diagonal) {
  const auto at = [&](std::size_t column) { return front.data() + column * rows; };
  std::vector<double> by_block;
  for (std::size_t start = 0; start < columns; start += kPanel) {
    const std::size_t end = std::min(columns, start + kPanel);
    for (std::size_t k = start; k < end; ++k) {
      double* pivot = at(k);
      const double d = pivot[k];
      if (!(std::abs(d) > 0 && std::isfinite(d))) return false;
      diagonal[k] = d;
      for (std::size_t j = k + 1; j < end; ++j) subtract(pivot, -pivot[j] / d, j, rows, at(j));
    }
    for (std::size_t k = start; k < end; ++k) {
      double* pivot = at(k);
      for (std::size_t i = k + 1; i < rows; ++i) pivot[i] /= diagonal[k];
    }
    pack_panel(at, start, end, rows, by_block);
    std::size_t j = end;
    for (; j + kBlockColumns <= rows; j += kBlockColumns)
      subtract_panel<kBlockColumns>(at, start, end, j, rows, diagonal, by_block);
    for (; j < rows; ++j) subtract_panel<1>(at, start, end, j, rows, diagonal, by_block);
  }
  return true;
}

bool SupernodalFactor::factorise(const Eigen::SparseMatrix<double>& lower, double shift) {
  struct Update {  // what a node leaves for its parent: a lower triangle, packed
    std::vector<int> rows;
    std::vector<double> value;
  };
  std::vector<std::vector<Update>> waiting(nodes_.size());
  std::vector<int> local(static_cast<std::size_t>(size_));
  std::vector<double> front;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Node& node = nodes_[k];
    const std::size_t n = node.rows.size(), columns = static_cast<std::size_t>(node.columns);
    front.assign(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) local[static_cast<std::size_t>(node.rows[i])] = static_cast<int>(i);
    for (std::size_t e = 0; e < node.entry.size(); ++e) front[node.entry_at[e]] += lower.valuePtr()[node.entry[e]];
    for (const std::uint32_t at : node.diagonal_at) front[at] += shift;
    for (Update& child : waiting[k]) {
      for (int& row : child.rows) row = local[static_cast<std::size_t>(row)];
      const std::size_t m = child.rows.size();
      for (std::size_t j = 0; j < m; ++j) {
        double* target = &front[static_cast<std::size_t>(child.rows[j]) * n];
        const double* column = child.value.data() + packed(m, j);
        for (std::size_t i = j; i < m; ++i) target[child.rows[i]] += column[i];
      }
    }
    waiting[k] = {};
    if (!eliminate(front, n, columns, &diagonal_[static_cast<std::size_t>(node.first)])) return false;
    for (std::size_t c = 0; c < columns; ++c) {
      const double* column = front.data() + c * n;
      std::copy(column + c, column + n, panel_.data() + node.panel + packed(n, c) + c);
    }
    if (n == columns) continue;
    const std::size_t m = n - columns;
    Update update{{node.rows.begin() + node.columns, node.rows.end()}, {}};
    update.value.reserve(m * (m + 1) / 2);
    for (std::size_t j = columns; j < n; ++j) {
      const double* column = front.data() + j * n;
      update.value.insert(update.value.end(), column + j, column + n);
    }
    waiting[static_cast<std::size_t>(node.parent)].push_back(std::move(update));
  }
  return true;
}

int SupernodalFactor::negative_pivots() const {
  return static_cast<int>(std::count_if(diagonal_.begin(), diagonal_.end(), [](double d) { return d < 0; }));
}

double SupernodalFactor::multiplications() const {
  double sum = 0;  // a column takes its products off the lower triangle that is left
  for (const Node& node : nodes_)
    for (int c = 0; c < node.columns; ++c) {
      const double left = static_cast<double>(node.rows.size()) - c;
      sum += 0.5 * left * left;
    }
  return sum;
}

Eigen::VectorXd SupernodalFactor::solve(const Eigen::VectorXd& b) const {
  Eigen::VectorXd out(size_);
  substitute<1>(b, 0, out);
  return out;
}

Eigen::MatrixXd SupernodalFactor::solve_all(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd out(size_, b.cols());
  for (Eigen::Index first = 0; first < b.cols(); first += kLanes) {
    const Eigen::Index left = b.cols() - first;
    if (left > kLanes / 2)
      substitute<kLanes>(b, first, out);
    else if (left > 1)
      substitute<kLanes / 2>(b, first, out);
    else
      substitute<1>(b, first, out);
  }
  return out;
}

template <std::size_t kColumns>
std::array<const double*, kColumns> SupernodalFactor::columns_of(const Node& node, std::size_t c) const {
  std::array<const double*, kColumns> column;
  for (std::size_t k = 0; k < kColumns; ++k) column[k] = panel_.data() + node.panel + packed(node.rows.size(), c + k);
  return column;
}

template <std::size_t kColumns, class Row>
void SupernodalFactor::forward_columns(const Node& node, std::size_t c, Row* x) const {
  const auto column = columns_of<kColumns>(node, c);
  typename Row::Lanes value[kColumns][Row::kCount];
  for (std::size_t l = 0; l < Row::kCount; ++l)
    for (std::size_t k = 0; k < kColumns; ++k) {
      value[k][l] = x[node.first + static_cast<int>(c + k)].lanes[l];
      for (std::size_t j = 0; j < k; ++j) value[k][l] -= column[j][c + k] * value[j][l];
      x[node.first + static_cast<int>(c + k)].lanes[l] = value[k][l];
    }
  for (std::size_t i = c + kColumns; i < node.rows.size(); ++i)
    for (std::size_t l = 0; l < Row::kCount; ++l) {
      auto row = x[node.rows[i]].lanes[l];
      for (std::size_t k = 0; k < kColumns; ++k) row -= column[k][i] * value[k][l];
      x[node.rows[i]].lanes[l] = row;
    }
}

template <std::size_t kColumns, class Row>
void SupernodalFactor::backward_columns(const Node& node, std::size_t c, Row* x) const {
  const auto column = columns_of<kColumns>(node, c);
  typename Row::Lanes value[kColumns][Row::kCount];
  for (std::size_t l = 0; l < Row::kCount; ++l)
    for (std::size_t k = 0; k < kColumns; ++k) value[k][l] = x[node.first + static_cast<int>(c + k)].lanes[l];
  for (std::size_t i = c + kColumns; i < node.rows.size(); ++i)
    for (std::size_t l = 0; l < Row::kCount; ++l) {
      const auto row = x[node.rows[i]].lanes[l];
      for (std::size_t k = 0; k < kColumns; ++k) value[k][l] -= column[k][i] * row;
    }
  for (std::size_t l = 0; l < Row::kCount; ++l)
    for (std::size_t k = kColumns; k-- > 0;) {
      for (std::size_t j = k + 1; j < kColumns; ++j) value[k][l] -= column[k][c + j] * value[j][l];
      x[node.first + static_cast<int>(c + k)].lanes[l] = value[k][l];
    }
}

template <class Row>
void SupernodalFactor::forward(const Node& node, Row* x) const {
  const auto columns = static_cast<std::size_t>(node.columns), groups = columns / kTogether * kTogether;
  for (std::size_t c = 0; c < groups; c += kTogether) forward_columns<kTogether>(node, c, x);
  for (std::size_t c = groups; c < columns; ++c) forward_columns<1>(node, c, x);
}

template <class Row>
void SupernodalFactor::backward(const Node& node, Row* x) const {
  const auto columns = static_cast<std::size_t>(node.columns), groups = columns / kTogether * kTogether;
  for (std::size_t c = columns; c-- > groups;) backward_columns<1>(node, c, x);
  for (std::size_t c = groups; c > 0; c -= kTogether) backward_columns<kTogether>(node, c - kTogether, x);
}

template <int kWide>
void SupernodalFactor::substitute(const Eigen::Ref<const Eigen::MatrixXd>& b, Eigen::Index first,
                                  Eigen::Ref<Eigen::MatrixXd> out) const {
  using Row = SideRow<kWide>;
  const auto count = static_cast<std::size_t>(std::min<Eigen::Index>(kWide, b.cols() - first));
  std::vector<Row> x(static_cast<std::size_t>(size_));
  for (int i = 0; i < size_; ++i)
    for (std::size_t k = 0; k < count; ++k)
      x[static_cast<std::size_t>(new_of_old_[static_cast<std::size_t>(i)])].set(k, b(i, first + static_cast<int>(k)));
  for (const Node& node : nodes_) forward(node, x.data());
  for (std::size_t i = 0; i < x.size(); ++i)
    for (auto& lanes : x[i].lanes) lanes /= diagonal_[i];
  for (std::size_t k = nodes_.size(); k-- > 0;) backward(nodes_[k], x.data());
  for (int i = 0; i < size_; ++i)
    for (std::size_t k = 0; k < count; ++k)
      out(i, first + static_cast<int>(k)) = x[static_cast<std::size_t>(new_of_old_[static_cast<std::size_t>(i)])].at(k);
}

}  // namespace palpate::fem

#undef PALPATE_FUSED
