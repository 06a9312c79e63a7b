/* Linked with the source list of a shared library. If a file is missing from the list, linking fails. */
int main(void)
{
    return 0;
}
