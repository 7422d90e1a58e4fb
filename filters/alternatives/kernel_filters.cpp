// The filters that studies run beside Ekf: every kernel, both errors.
#include "filters/ekf/basic_ekf.hpp"
#include "leeway/alternatives/dense_kernel.hpp"
#include "leeway/alternatives/invariant_ekf.hpp"
#include "leeway/alternatives/ud_kernel.hpp"

namespace leeway {

template class BasicEkf<SymmetricKernel<float>>;
template class BasicEkf<DenseKernel<float>>;
template class BasicEkf<DenseKernel<double>>;
template class BasicEkf<UdKernel<float>>;
template class BasicEkf<UdKernel<double>>;
template class BasicEkf<SymmetricKernel<float>, InvariantError>;
template class BasicEkf<SymmetricKernel<double>, InvariantError>;
template class BasicEkf<DenseKernel<float>, InvariantError>;
template class BasicEkf<DenseKernel<double>, InvariantError>;
template class BasicEkf<UdKernel<float>, InvariantError>;
template class BasicEkf<UdKernel<double>, InvariantError>;

}  // namespace leeway
