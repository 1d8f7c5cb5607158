"""The handbook at /help: every chapter is served, every link and anchor in it leads somewhere, and a page of it needs nothing from elsewhere.

In: the real program. Out: judgements on what a browser would get, without a sign-in.
"""
import gzip
import html.parser
import json
import pathlib
import re
import urllib.parse

from harness import DEMO, Gateway

TOP = pathlib.Path(__file__).resolve().parents[2]


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.ids, self.loads, self.inline, self.current = [], [], [], [], 0
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        a = dict(attributes)
        if "id" in a:
            self.ids.append(a["id"])
        if tag == "a":
            self.links.append(a["href"])
            self.current += "aria-current" in a
        if tag in ("script", "img"):
            self.loads.append(a.get("src", ""))
        if tag == "link":
            self.loads.append(a["href"])
        if tag == "style" or "style" in a or any(k.startswith("on") for k in a):
            self.inline.append((tag, a))


def get(gateway, path, **headers):
    status, body, head = gateway.request("GET", path, None, {"Accept": "text/html", **headers})
    return status, body, head


def chapters(gateway):
    """All pages that can be reached from the contents, by their address."""
    pages, waiting = {}, ["/help/"]
    while waiting:
        path = waiting.pop()
        if path in pages:
            continue
        status, body, head = get(gateway, path)
        assert status == 200 and head["Content-Type"] == "text/html; charset=utf-8", (path, status)
        assert "default-src 'self'" in head["Content-Security-Policy"] and "unsafe" not in head["Content-Security-Policy"], head
        pages[path] = Page(body.decode())
        waiting += [p for p in (urllib.parse.urldefrag(urllib.parse.urljoin(path, link)).url for link in pages[path].links) if p.startswith("/help/")]
    return pages


def test_every_chapter_is_served_and_every_link_leads_somewhere(folder):
    # As an installed gateway has it: nobody has signed in.
    with Gateway(folder, DEMO, "--set", "users.local_role=none") as g:
        assert get(g, "/api/v1/axes")[0] == 401
        pages = chapters(g)
        written = {f"/help/{p.stem}.html" for p in (TOP / "docs/handbook").glob("*.md")} - {"/help/README.html"}
        assert written <= set(pages), f"not in the contents: {sorted(written - set(pages))}"
        assert {"/help/http.html", "/help/gateway-doors-modbus.html", "/help/gateway-doors-enip.html"} <= set(pages)
        families = {f"/help/adapters-{p.parent.name}.html" for p in (TOP / "adapters").glob("*/README.md")} - {"/help/adapters-example.html"}
        assert families <= set(pages), sorted(families - set(pages))
        for path, page in pages.items():
            assert not page.inline, (path, page.inline)
            assert len(page.ids) == len(set(page.ids)), path
            assert page.current == (0 if path == "/help/" else 1), path
            for link in page.links:
                url = urllib.parse.urljoin(path, link)
                assert url.startswith("/"), f"{path} leads elsewhere: {link}"
                bare, anchor = urllib.parse.urldefrag(url)
                if bare.startswith("/help/"):
                    assert not anchor or anchor in pages[bare].ids, f"{path}: {link}"
                else:
                    assert bare in ("/", "/api/v1/openapi.yaml"), f"{path}: {link}"
            for load in page.loads:
                assert load.startswith("/") and get(g, load)[0] == 200, (path, load)


def test_the_contents_answer_at_help_and_what_is_not_there_is_not_the_page(gateway):
    for path in ("/help", "/help/", "/help/index.html"):
        status, body, _ = get(gateway, path)
        assert status == 200 and b"<h1" in body and b"Handbook" in body, path
    assert get(gateway, "/help/no-such-chapter.html")[0] == 404
    status, packed, head = get(gateway, "/help/trouble.html", **{"Accept-Encoding": "gzip"})
    assert status == 200 and head["Content-Encoding"] == "gzip" and b"Wireshark" in gzip.decompress(packed)
    tag = head["ETag"]
    assert get(gateway, "/help/trouble.html", **{"Accept-Encoding": "gzip", "If-None-Match": tag})[0] == 304


def test_the_search_knows_every_heading_and_leads_there(gateway):
    status, entries, head = gateway.request("GET", "/help/search.json")
    assert status == 200 and head["Content-Type"] == "application/json"
    pages = chapters(gateway)
    assert len(entries) > 200
    for e in entries:
        bare, anchor = urllib.parse.urldefrag(e["to"])
        assert bare in pages and (not anchor or anchor in pages[bare].ids), e["to"]
    found = [e["to"] for e in entries if "wireshark" in (e["heading"] + e["text"]).lower()]
    assert "/help/trouble.html#in-wireshark" in found, found


def test_a_chapter_says_what_its_source_says(gateway):
    _, body, _ = get(gateway, "/help/door-modbus-tcp.html")
    text = re.sub(r"<[^>]+>", "", body.decode())
    for words in ("For PLC, panel and SCADA", "exception 0Ah", "Move an axis by registers"):
        assert words in text, words
    assert json.dumps("mbpoll")[1:-1] in text and "```" not in text and "](" not in text
