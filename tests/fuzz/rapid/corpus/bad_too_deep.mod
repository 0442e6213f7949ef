MODULE M
  VAR num n;
  PROC main()
    n:=((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((1))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))))));
    n:=n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n+n;
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    IF n=0 THEN
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
    ENDIF
  ENDPROC
ENDMODULE
