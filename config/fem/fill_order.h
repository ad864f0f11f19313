// In which order the unknowns of a sparse symmetric matrix are eliminated, so that its factor fills little.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace palpate::fem {

// Where every unknown goes: small matrices by minimum degree (Amestoy, Davis & Duff 1996), others by nested dissection
// (METIS; Karypis & Kumar 1998), whose factors of bodies in space are smaller the larger these are. `lower`: the lower
// triangle with its diagonal, compressed. Every process and thread gets the same. Throws std::bad_alloc without memory.
//
// half_shell on elements of 12 to 1.6 mm, million entries and seconds of a factor (2 cores, beside other work,
// 2026-11-26):
//   unknowns             1,683   3,954   7,236   20,949   41,082   100,572   330,000
//   minimum degree        0.15    0.47    1.13     6.57    17.8      80.8
//                                                   0.3     1.0       8.6
//   nested dissection     0.16    0.52    1.10     4.85    13.3      54.1     304
//                                                   0.1     0.6       3.6      41
std::vector<int> fill_order(const Eigen::SparseMatrix<double>& lower);

// The unknowns one after another, by minimum degree. `whole`: both triangles.
std::vector<int> minimum_degree(const Eigen::SparseMatrix<double>& whole);

}  // namespace palpate::fem
