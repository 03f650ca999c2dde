// Finds the features of surfaces that are free of contact because an attachment joins them.
#pragma once

#include "muslin/contact/contact_model.hpp"
#include "muslin/scene/model.hpp"

namespace muslin {

/// The points of the first body at a joint are free of the triangles of the second body around the joint:
/// those within a mean edge of the finer of both bodies, besides thickness and contact distance. Joints whose
/// points keep a larger distance exempt nothing. `contact` needs surface, rest positions, names and distance.
ContactExemptions exemptions_at_joints(const Model& model, const ContactModel& contact);

}  // namespace muslin
