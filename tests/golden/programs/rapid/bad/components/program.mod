MODULE M
  VAR num n;
  VAR robtarget p1;
  VAR jointtarget home:=[[0,0,0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    n:=p1.trans;
    n:=p1.rot.q1;
    p1.trans.w:=1;
    n:=home.robax.rax_7;
    n:=home.extax.eax_a;
    n:=n.x;
    n:=q.trans.x;
  ENDPROC
ENDMODULE
