#pragma once

namespace udar {

/// A symmetric tensor of plane strain in the fixed axes: in-plane components and the normal one out of the plane.
/// `Real` is double or a pack of lanes. Stress in Pa; strain without unit.
template <class Real>
struct SymTensor {
  Real xx{};
  Real yy{};
  Real xy{};
  Real zz{};
};

template <class Real>
constexpr SymTensor<Real> operator+(const SymTensor<Real>& a, const SymTensor<Real>& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.xy + b.xy, a.zz + b.zz};
}
template <class Real>
constexpr SymTensor<Real> operator-(const SymTensor<Real>& a, const SymTensor<Real>& b) {
  return {a.xx - b.xx, a.yy - b.yy, a.xy - b.xy, a.zz - b.zz};
}

}  // namespace udar
