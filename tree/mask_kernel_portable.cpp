#define SURFELAO_MASK_ISA mask_portable
#define SURFELAO_MASK_ISA_NAME "portable"

#include "tree/mask_kernel_body.h"

namespace surfelao {

const MaskKernel kMaskKernelPortable = mask_portable::kKernel;

}  // namespace surfelao
