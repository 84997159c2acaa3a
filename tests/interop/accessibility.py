"""Accessibility of a page in a browser, by axe-core, which tools/setup installs."""


def violations(browser, source):
    """Serious and critical violations of the page that the browser shows, one line each."""
    script = next(source.glob(".deps/python/lib/python3*/site-packages/axe_playwright_python/axe.min.js")).read_text()
    browser.execute_script(script)
    found = browser.execute_async_script("axe.run(document, {resultTypes: ['violations']}).then(arguments[0]);")["violations"]
    return [f"{one['impact']}: {one['id']}: {one['help']}: {node['html'][:200]}" for one in found if one["impact"] in ("serious", "critical")
            for node in one["nodes"]]
