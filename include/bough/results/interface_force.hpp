#pragma once
/// Forces at the interfaces of sub-domains.
#include <optional>
#include <span>
#include <string>

#include "bough/step/system.hpp"

namespace bough::results {

/// The sub-domain that is reached from the root by taking a certain child at each level; none: there is no such child.
tree::SubdomainId subdomain_at(const tree::Tree& tree, std::span<const int> path);

/// The wrench with which the rest of the structure holds a sub-domain at the nodes of its interface, in the axes of the
/// ground: the force, and the moment about the mean position of these nodes. It is the sum of the residuals, at these
/// nodes, of the elements inside; these are the local multipliers l of the sub-domain, (2) in src/solve/README.md, at a
/// state in equilibrium. In statics residuals include the first-order change f + K eta that the last correction leaves
/// (State::unsettled). Precondition: the sub-domain is not the root.
motion::Vec6<double> eval_interface_force(const step::System& system, const step::State& state,
                                          const elements::Field& field, tree::SubdomainId subdomain);

/// The wrench of a part of the scene, all of whose elements are given, on what it acts on: of a load or a prescribed
/// motion at its place, of a line load about the start of its first element, of a spring or bushing on the second at
/// its end; (force [N], moment [N m]) in the axes of the ground. It is minus the residual of the elements at these
/// ports, as above. On the ground it is what balances the wrench on the other side.
struct PartForce {
  motion::Vec6<double> wrench = motion::Vec6<double>::zero();
  motion::Mat3<double> axes = motion::Mat3<double>::identity();  ///< of the place where it acts, in the ground
};
PartForce eval_part_force(const step::System& system, const step::State& state, const elements::Field& field,
                          std::span<const int> part);

}  // namespace bough::results
