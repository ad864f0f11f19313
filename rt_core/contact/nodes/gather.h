// Fills the contact problem from the image: how the candidate nodes move one another.
#pragma once

#include "rt_core/contact/nodes/contact_problem.h"
#include "rt_core/model.h"

namespace palpate {

inline bool is_held(const Model& model, const ContactNode& node) PALPATE_RT {
  return model.nodal_vertex[static_cast<std::size_t>(node.vertex)].is_free == 0;
}
// Rows and columns of the compliance at the candidates: problem.influence. Bound: 9 kMaxContacts^2 numbers.
void gather_influence(const Model& model, ContactProblem& problem) PALPATE_RT;
// Normal compliances problem.normal.compliance = N (C + G K_coupling^-1 G^T) N^T, in double precision, with the
// regularisation on the diagonal and a stiff wall under held nodes. Needs normals and arms. Bound: kMaxContacts^2.
void gather_normal(const Model& model, ContactProblem& problem) PALPATE_RT;
// Every node's tangents, turned to those of its own compliance, and its friction block. Bound: kMaxContacts.
void make_frames(const Model& model, ContactProblem& problem, Real mu) PALPATE_RT;

}  // namespace palpate
