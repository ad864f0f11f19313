// How far the body is strained where it is strained most: the check of the linear range.
#pragma once

#include "rt_core/contact/nodes/contact_problem.h"
#include "rt_core/model.h"

namespace palpate {

// Largest equivalent strain over the image's gauges under the pushes of the problem; 0 without gauges. Equivalent:
// sqrt(2/3) times the Frobenius norm, which is the axial strain of an incompressible bar. Bound: kMaxContacts times
// 18 kMaxStrainGauges multiplications.
Real largest_strain(const Model& model, const ContactProblem& problem) PALPATE_RT;

}  // namespace palpate
