// What TypeScript's own libraries lack, for `tsc --noEmit`: constants of WebGPU. Not part of pages.
declare const GPUBufferUsage: Record<string, number>;
declare const GPUTextureUsage: Record<string, number>;
declare const GPUShaderStage: Record<string, number>;
declare const GPUMapMode: Record<string, number>;
