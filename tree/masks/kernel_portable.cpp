#define SURFELAO_MASK_ISA mask_portable
#define SURFELAO_MASK_ISA_NAME "portable"

#include "tree/masks/kernel_body.h"

namespace surfelao {

const MaskKernel kMaskKernelPortable = mask_portable::kKernel;

}  // namespace surfelao
