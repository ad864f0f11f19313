#include "config/fem/fill_order.h"

#include <metis.h>

#include <Eigen/OrderingMethods>
#include <mutex>
#include <new>

namespace palpate::fem {

namespace {

// From so many unknowns on a dissection fills less than minimum degree; the table of fill_order.h.
constexpr int kLeastDissected = 7000;

static_assert(sizeof(idx_t) == sizeof(int), "METIS with numbers of 32 bits, as Debian has it");

// Every unknown's neighbours, one after another.
struct Graph {
  std::vector<int> start, neighbour;
};
Graph graph_of(const Eigen::SparseMatrix<double>& lower) {
  const auto n = static_cast<std::size_t>(lower.cols());
  Graph graph{std::vector<int>(n + 1), {}};
  const auto each_pair = [&](const auto& use) {
    for (int column = 0; column < lower.outerSize(); ++column)
      for (Eigen::SparseMatrix<double>::InnerIterator it(lower, column); it; ++it)
        if (it.row() != column) use(static_cast<std::size_t>(it.row()), static_cast<std::size_t>(column));
  };
  each_pair([&](std::size_t a, std::size_t b) {
    ++graph.start[a + 1];
    ++graph.start[b + 1];
  });
  for (std::size_t i = 0; i < n; ++i) graph.start[i + 1] += graph.start[i];
  graph.neighbour.resize(static_cast<std::size_t>(graph.start[n]));
  std::vector<int> next(graph.start.begin(), graph.start.end() - 1);
  each_pair([&](std::size_t a, std::size_t b) {
    graph.neighbour[static_cast<std::size_t>(next[a]++)] = static_cast<int>(b);
    graph.neighbour[static_cast<std::size_t>(next[b]++)] = static_cast<int>(a);
  });
  return graph;
}

std::vector<int> nested_dissection(const Eigen::SparseMatrix<double>& lower) {
  int n = static_cast<int>(lower.cols());
  std::vector<int> place(static_cast<std::size_t>(n)), order(static_cast<std::size_t>(n));
  Graph graph = graph_of(lower);
  // METIS draws from rand(), which it seeds at every call: not while another thread does.
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  if (METIS_NodeND(&n, graph.start.data(), graph.neighbour.data(), nullptr, nullptr, order.data(), place.data()) !=
      METIS_OK)
    throw std::bad_alloc();
  return place;
}

}  // namespace

std::vector<int> minimum_degree(const Eigen::SparseMatrix<double>& whole) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
  Eigen::AMDOrdering<int>()(whole, inverse);
  return {inverse.indices().data(), inverse.indices().data() + whole.cols()};
}

std::vector<int> fill_order(const Eigen::SparseMatrix<double>& lower) {
  if (lower.cols() >= kLeastDissected) return nested_dissection(lower);
  std::vector<int> place(static_cast<std::size_t>(lower.cols()));
  int next = 0;
  for (const int unknown : minimum_degree(lower.selfadjointView<Eigen::Lower>()))
    place[static_cast<std::size_t>(unknown)] = next++;
  return place;
}

}  // namespace palpate::fem
