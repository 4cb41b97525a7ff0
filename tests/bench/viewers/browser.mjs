// browser.mjs: draws jobs in headless chromium, without a GPU.
//
//     node browser.mjs JOBS.json MODULES        MODULES: a node_modules with three, puppeteer-core
//
// Each job {page, file, picture, ...} is given to its page's show(); what that says besides the
// picture goes to standard output as one JSON list.
import { createRequire } from 'node:module';
import { readFileSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const [jobsFile, modules] = process.argv.slice(2).map(word => path.resolve(word));
const require = createRequire(path.join(modules, 'x.js'));
const { default: puppeteer } = await import(pathToFileURL(require.resolve('puppeteer-core')));
const jobs = JSON.parse(readFileSync(jobsFile));

const types = { '.html': 'text/html', '.js': 'text/javascript', '.json': 'application/json', '.png': 'image/png' };
const roots = { pages: import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), modules, files: '/' };
const server = createServer((request, response) => {
    const [, root, ...rest] = decodeURIComponent(new URL(request.url, 'http://x').pathname).split('/');
    try {
        const file = path.join(roots[root], ...rest);
        const data = readFileSync(file);
        response.writeHead(200, { 'Content-Type': types[path.extname(file)] ?? 'application/octet-stream' });
        response.end(data);
    } catch {
        response.writeHead(404).end();
    }
});
await new Promise(done => server.listen(0, '127.0.0.1', done));
const at = `http://127.0.0.1:${server.address().port}`;

const browser = await puppeteer.launch({
    executablePath: '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'],
});
const said = [];
for (const name of new Set(jobs.map(job => job.page))) {
    const page = await browser.newPage();
    page.on('console', message => console.error(`${name}: ${message.text()}`));
    page.on('pageerror', error => console.error(`${name}: ${error}`));
    await page.goto(`${at}/pages/${name}`);
    await page.waitForFunction('window.ready');
    for (const job of jobs.filter(job => job.page === name)) {
        const { picture, ...others } = await page.evaluate(
            job => window.show(job), { ...job, file: `${at}/files${job.file}` });
        writeFileSync(job.picture, Buffer.from(picture.split(',')[1], 'base64'));
        said.push({ picture: job.picture, ...others });
    }
}
await browser.close();
server.close();
console.log(JSON.stringify(said));
