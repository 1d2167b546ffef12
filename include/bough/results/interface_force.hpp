#pragma once
/// Forces at the interfaces of sub-domains.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bough/step/system.hpp"

namespace bough::results {

/// The sub-domain that is reached from the root by taking a certain child at each level; none: there is no such child.
tree::SubdomainId subdomain_at(const tree::Tree& tree, std::span<const int> path);

/// What the rest of the structure exerts on a sub-domain at one node of its interface.
struct InterfaceForce {
  int node = -1;
  /// Force [N], and moment about the node's origin [N m], in the axes of the ground.
  motion::Vec6<double> wrench = motion::Vec6<double>::zero();
};

/// The wrenches with which the rest of the structure holds a sub-domain at the nodes of its interface, ascending: the
/// sums of the residuals, there, of the elements inside. They are the local multipliers l of the sub-domain, (2) of
/// theory/method.md, at a state in equilibrium. In statics residuals include the first-order change f + K eta that
/// the last correction leaves (State::unsettled). Precondition: the sub-domain is not the root.
std::vector<InterfaceForce> eval_interface_forces(const step::System& system, const step::State& state,
                                                  const elements::Field& field, tree::SubdomainId subdomain);

/// Their sum: the force, and the moment about the mean position of the nodes.
motion::Vec6<double> resultant_of(std::span<const InterfaceForce> forces, const elements::Field& field);

/// The wrench of a part of the scene, all of whose elements are given, on what it acts on: of a load or a prescribed
/// motion at its place, of a line load about the start of its first element, of a coupling on the second at its
/// end; (force [N], moment [N m]) in the axes of the ground. It is minus the residual of the elements at these
/// ports, as above. On the ground it is what balances the wrench on the other side.
struct PartForce {
  motion::Vec6<double> wrench = motion::Vec6<double>::zero();
  motion::Mat3<double> axes = motion::Mat3<double>::identity();  ///< of the place where it acts, in the ground
};
PartForce eval_part_force(const step::System& system, const step::State& state, const elements::Field& field,
                          std::span<const int> part);

}  // namespace bough::results
