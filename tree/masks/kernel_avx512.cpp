#define SURFELAO_MASK_ISA mask_avx512
#define SURFELAO_MASK_ISA_NAME "avx512"

#include "tree/masks/kernel_body.h"

namespace surfelao {

const MaskKernel kMaskKernelAvx512 = mask_avx512::kKernel;

}  // namespace surfelao
