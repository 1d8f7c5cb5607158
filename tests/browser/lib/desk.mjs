// Desk: what a person does with the draft of the site on its page: check, apply on trial, keep; and what the gateway then has.
// In: where to find the program and the page, which a test opens later. Out: steps that wait for their answer. Never judges more than that.
import { until } from './browser.mjs';

export function deskOf(at) {
  const stage = () => at().page.locator('[data-field=stage]').first();
  const told = (field) => at().page.locator(`[data-field="${field}"]`).first().innerText();
  const site = async () => (await at().program.call('GET', '/site')).body;
  const axis = async (name) => (await site()).axes.find((a) => a.name === name);
  const checkIt = async () => {
    await stage().getByRole('button', { name: 'Check', exact: true }).click();
    await until('it is checked', async () => /^Checked|fault/.test(await told('stage-told')) || (await told('stage-told')));
  };
  const applyIt = async (seconds) => {
    await stage().getByLabel('Confirm within, s').fill(String(seconds));
    await stage().getByRole('button', { name: 'Apply', exact: true }).click();
    await until('it is applied', async () => /^Applied/.test(await told('stage-told')) || (await told('stage-told')));
  };
  const keepIt = async () => {
    await stage().getByRole('button', { name: 'Keep', exact: true }).click();
    await until('it is kept', async () => (await stage().getAttribute('data-state')) === 'none');
  };
  return { stage, told, site, axis, checkIt, applyIt, keepIt };
}
