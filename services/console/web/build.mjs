// Puts uPlot into the page's folder, all of which the service serves, without the address in its licence text.
import { copyFileSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = fileURLToPath(new URL('.', import.meta.url));
const page = join(here, 'page');
const uplot = join(here, 'node_modules/uplot');
const script = readFileSync(join(uplot, 'dist/uPlot.iife.min.js'), 'utf8').replace(/^\/\*[\s\S]*?\*\//, '');
const licence = readFileSync(join(uplot, 'LICENSE'), 'utf8');
writeFileSync(join(page, 'uplot.js'), `/*\n${licence}*/\n${script}`);
copyFileSync(join(uplot, 'dist/uPlot.min.css'), join(page, 'uplot.css'));

for (const name of readdirSync(page)) {
  if (/https?:\/\//.test(readFileSync(join(page, name), 'utf8'))) throw new Error(`${name} holds the address of a host`);
}
