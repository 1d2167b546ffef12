#pragma once
/// Views of the memory to which the assembler writes element matrices.
#include <array>
#include <cstdint>
#include <type_traits>

namespace bough::solve {

/// One element matrix, row-major in the element's block order, SI units: entry (i, j) of an n x n matrix is view[i *
/// n + j]. Equal elements of sub-domains that are factored in lockstep are interleaved, so consecutive entries are
/// `stride` doubles apart.
template <class Real>
struct BasicElementView {
  Real* first = nullptr;
  std::int64_t stride = 1;
  Real& operator[](std::int64_t k) const { return first[k * stride]; }
  operator BasicElementView<const Real>() const requires(!std::is_const_v<Real>) { return {first, stride}; }
  BasicElementView from(std::int64_t k) const { return {first + k * stride, stride}; }
};
using ElementView = BasicElementView<double>;
using ConstElementView = BasicElementView<const double>;

constexpr int lanes_wide = 8;  ///< sub-domains in lockstep; results do not depend on the width of registers

/// Equal elements that are evaluated together, one per lane, or a single element.
struct ElementBatch {
  std::array<int, lanes_wide> element;  ///< ids; -1 for an unused lane
  std::int64_t values = 0;              ///< first entry of lane 0, in doubles from the start of the store
  int stride = 1;                       ///< lanes_wide: interleaved; 1: only element[0]
};

}  // namespace bough::solve
