// Many: a site of 64 axes and 4096 mappings, for tests and benchmarks of the register map. In: nothing. Out: a document.
const points = [['statusword', 'u16', 1], ['position', 'i32', 2], ['velocity', 'i32', 2], ['error_code', 'u16', 1]];

export function manyMappings() {
  const numbers = Array.from({ length: 64 }, (_, i) => i + 1);
  return {
    lines: [{ name: 'can0', uri: 'twin', family: 'uim342', bitrate: 1_000_000 }],
    drives: numbers.map((i) => ({ name: `d${i}`, line: 'can0', address: i + 4, presence: 'twin' })),
    axes: numbers.map((i) => ({ name: `axis${i}`, drive: `d${i}`, channel: 1, number: i, unit: 'mm', increments_per_unit: 3200 })),
    mappings: Array.from({ length: 4096 }, (_, n) => {
      const [point, type] = points[n % 4];
      return { id: `m${n}`, unit: 2, table: 'holding_registers', address: n * 2, axis: `axis${(Math.floor(n / 4) % 64) + 1}`, point, type, word_order: 'high_first', scale: 1, offset: 0, access: 'R' };
    }),
  };
}
