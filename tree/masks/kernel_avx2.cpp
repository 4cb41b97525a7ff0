#define SURFELAO_MASK_ISA mask_avx2
#define SURFELAO_MASK_ISA_NAME "avx2"

#include "tree/masks/kernel_body.h"

namespace surfelao {

const MaskKernel kMaskKernelAvx2 = mask_avx2::kKernel;

}  // namespace surfelao
