// Chinese (simplified): sentences about axis, by their English ones, in the order of the alphabet.
// In: nothing. Out: a part of the table; a sentence stands in one part only.
import type { Table } from '../index';

export const axis: Table = {
  'A text is needed.': '需要填写文本。',
  'A value is needed.': '需要填写数值。',
  'A whole number.': '整数。',
  'Jog: ended, halt accepted': '点动：已结束，暂停已接受',
  'Jog: ended, {why}. The gateway halts the axis by itself {n} s after it last heard of the jog.': '点动：已结束，{why}。网关在最后一次收到点动信号 {n} s 后自动停住该轴。',
  'Jog: ended. {why}': '点动：已结束。{why}',
  'Jog: halt refused. {why}': '点动：暂停被拒绝。{why}',
  'Jog: the halt is NOT confirmed: {why}': '点动：暂停未被确认：{why}',
  'the connection to the gateway is lost': '与网关的连接已断开',
  'true or false.': 'true 或 false。',
  '{action} on {axis}: {question} Run it?': '对 {axis} 执行 {action}：{question} 是否执行？',
  '{from} to {to} {unit}.': '{from} 至 {to} {unit}。',
  '{from} to {to}.': '{from} 至 {to}。',
};
